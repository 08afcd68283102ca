// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../model/spherical_harmonics.hpp"
#include "../geometry/effect_set.hpp"
#include "../geometry/list_capacity.hpp"
#include "../geometry/splat.hpp"
#include "antialiasing.hpp"
#include "gaussian_row.hpp"
#include "geometry.hpp"

namespace gs::raster {

/// What the backward blending sums for a Gaussian over the pixels, with s = dL/dalpha alpha and (u, v) the
/// offset in widths of the splat (see `whitened`), in which a long thin splat's moments do not cancel. A
/// record is 12 values apart from the next, so that one commit touches two sectors.
enum sum { sum_red, sum_green, sum_blue, sum_s, sum_su, sum_sv, sum_suu, sum_suv, sum_svv, sum_count };
inline constexpr unsigned record_stride = 12;
/// Behind them, with depth maps: of the inverse of its depth.
inline constexpr unsigned sum_inverse_depth = sum_count;

/// What densification wants to know of a Gaussian, over the iterations since it last asked.
struct visibility {
    float gradient;  ///< sum of the norms of dL/d(center), in halves of the image's sides
    float seen;      ///< iterations in which it was drawn
};

/// Where `project_backward` puts gradients that are to be looked at: into arrays, zeros where a Gaussian took
/// part in no pixel.
template <class Real>
struct store_gradients {
    parameter_arrays<Real> to;

    static constexpr bool takes_zeros = true;
    WARPAGG_HD bool idle() const { return false; }

    template <class W>
    struct row_sink {
        const store_gradients& of;
        const W& w;
        const gaussian_row<W>& row;

        template <int N, class V>
        WARPAGG_HD void operator()(parameter p, std::size_t k, std::size_t width, const glm::vec<N, V>&,
                                   const glm::vec<N, V>& gradient) const {
            for (int n = 0; n < N; ++n)
                w.store_row(of.to[p], row.at(k, n, width), select(row.active, gradient[n], V(0)), row.inside);
        }
    };
    template <class W>
    WARPAGG_HD row_sink<W> for_row(const W& w, const gaussian_row<W>& row) const {
        return {*this, w, row};
    }
};

/// From the sums over pixels to the gradients of the parameters, a Gaussian a lane. A Gaussian takes part in
/// the step if any of its sums is not zero: else all its gradients are. What `Sink::for_row` returns is given
/// the value and the gradient of each parameter of those that take part, three components or so at a time,
/// and may change the value at once: it has been read by all that needs it. `Sink::takes_zeros` says whether
/// it wants the others' as well.
template <class W, class Real, class Sink, effect_set Effects>
struct project_backward {
    using real = value_t<W, Real>;

    parameter_arrays<const Real> gaussians;
    std::size_t count;
    device_camera<real> camera;
    int sh_degree;
    int learned_sh_degree;  ///< no gradients of bands above it
    const splat<Real>* splats;
    const std::uint32_t* tiles;
    const Real* sums;  ///< `record_stride` a Gaussian
    Sink sink;
    visibility* seen;        ///< null: nobody wants to know
    list_capacity capacity;  ///< of the view

    WARPAGG_HD void operator()(const W& w, unsigned warp_index) const {
        if (sink.idle()) return;
        const auto i = w.lane() + warp_index * W::size;
        gaussian_row<W> row{std::size_t{warp_index} * W::size, i < static_cast<unsigned>(count), false};
        const mask_t<W> drawn =
            w.load_row(tiles, static_cast<std::ptrdiff_t>(row.first), row.inside) != value_t<W, unsigned>(0);
        real s[sum_count + (Effects.depth ? 1 : 0)];
        for (unsigned k = 0; k < sum_count; ++k) {
            s[k] = w.load(sums, i * record_stride + k, drawn);
            row.active = row.active || s[k] != real(0);
        }
        if constexpr (Effects.depth) row.active = load_depth_sum(w, i, drawn, s) || row.active;
        vec2<real> center(real(0));
        if (Sink::takes_zeros || w.any(row.active)) center = differentiate(w, row, i, s);
        if (seen != nullptr) note(w, i, drawn, row.active, center);
    }

  private:
    /// Returns where it is not zero.
    WARPAGG_HD mask_t<W> load_depth_sum(const W& w, const value_t<W, unsigned>& i, const mask_t<W>& drawn,
                                        real* s) const {
        s[sum_inverse_depth] = w.load(sums, i * record_stride + sum_inverse_depth, drawn);
        return s[sum_inverse_depth] != real(0);
    }

    /// Returns the gradient of the center, in pixels.
    WARPAGG_HD vec2<real> differentiate(const W& w, const gaussian_row<W>& row, const value_t<W, unsigned>& i,
                                        const real* s) const {
        const auto mean = row.template load<3>(w, gaussians.mean, 0, 3);
        const auto log_scale = row.template load<3>(w, gaussians.log_scale, 0, 3);
        const auto quaternion = row.template load<4>(w, gaussians.quaternion, 0, 4);
        const auto opacity = row.template load<1>(w, gaussians.opacity, 0, 1);
        const footprint<real, Effects> f(in_camera(mean, camera), log_scale, quaternion, camera);
        const auto put = sink.for_row(w, row);
        // L depends on the exponent through alpha = o exp(-ln2 (u^2 + v^2)), and s = dL/dalpha alpha. With M
        // the rows (p, 0), (r, q), the inverse covariance is 2 ln2 M^T M and (u, v) = M d.
        const real two_ln2 = constant<real>(1.3862943611198906);
        const real p = f.shape.p, q = f.shape.q, r = f.shape.r;
        const vec2<real> center = two_ln2 * vec2<real>(p * s[sum_su] + r * s[sum_sv], q * s[sum_sv]);

        // dL/dcovariance = (2 ln2)^2 / 2 M^T W M with W the second moments, and the covariance is the Gram
        // matrix of ax and ay, whose whitened forms are `axes`.
        const whitened_axes<real> axes(f.shape, f.ax, f.ay);
        const real k = two_ln2 * two_ln2;
        vec3<real> nx = k * (s[sum_suu] * axes.x + s[sum_suv] * axes.y),
                   ny = k * (s[sum_suv] * axes.x + s[sum_svv] * axes.y);
        if constexpr (Effects.antialiasing) add_opacity_left_gradient(axes, s[sum_s], nx, ny);
        const vec3<real> dax = p * nx + r * ny, day = q * ny;

        // The mean moves the center and the Jacobian, the depth, and the direction that the color is seen
        // from.
        vec3<real> by_position = f.seen.position_gradient(center, f.rotation * (dax * f.scale),
                                                          f.rotation * (day * f.scale), camera);
        if constexpr (Effects.depth)
            by_position += f.seen.inverse_depth_gradient(s[sum_inverse_depth], camera);
        put(parameter::log_scale, 0, 3, log_scale, nx * axes.x + ny * axes.y);
        put(parameter::quaternion, 0, 4, quaternion, turn(f, dax * f.scale, day * f.scale));
        // mutate: one_minus_opacity_rounded
        put(parameter::opacity, 0, 1, opacity, glm::vec<1, real>(s[sum_s] * sigmoid(-opacity.x)));
        put(parameter::mean, 0, 3, mean, by_position + color(w, row, put, i, mean, s));
        return center;
    }

    /// ax = (px R) * scale: through R to the quaternion.
    static WARPAGG_HD vec4<real> turn(const footprint<real, Effects>& f, const vec3<real>& sax,
                                      const vec3<real>& say) {
        mat3<real> rotation;
        for (int c = 0; c < 3; ++c) rotation[c] = sax[c] * f.seen.px + say[c] * f.seen.py;
        const vec4<real> g = rotation_gradient(f.turn, rotation);
        // Only the part across the quaternion turns anything.
        return (g - f.turn * glm::dot(f.turn, g)) * f.inverse_length;
    }

    /// Returns the mean's gradient through the direction.
    template <class Put>
    WARPAGG_HD vec3<real> color(const W& w, const gaussian_row<W>& row, const Put& put,
                                const value_t<W, unsigned>& i, const vec3<real>& mean, const real* s) const {
        // A channel that the forward pass held at a bound takes no gradient.
        constexpr unsigned red = offsetof(splat<Real>, red) / sizeof(Real);
        const auto free = [&](unsigned channel) {
            const real shown =
                w.load(reinterpret_cast<const Real*>(splats), i * splat_width + red + channel, row.active);
            return select(shown > real(0) && shown < constant<real>(most_color), s[sum_red + channel],
                          real(0));
        };
        const vec3<real> g(free(0), free(1), free(2));
        const int degree = row.degree_of(gaussians, sh_degree);
        const unit<3, real> sight(mean - camera.center);
        const vec3<real> direction = sight.direction;
        real basis[16]{}, weight[16]{};
        sh_basis(degree, direction, basis);
        WARPAGG_UNROLL
        for (int band = 0; band < 4; ++band) {
            if (band > degree) break;
            const int size = 2 * band + 1;
            WARPAGG_UNROLL
            for (int m = 0; m < size; ++m) {
                const int k = band * band + m;
                const std::size_t component = static_cast<std::size_t>(3 * m),
                                  width = static_cast<std::size_t>(3 * size);
                const auto value = row.template load<3>(w, gaussians.sh[band], component, width);
                weight[k] = glm::dot(g, value);
                if (band <= learned_sh_degree) put(sh_band(band), component, width, value, basis[k] * g);
            }
        }
        const vec3<real> d = sh_gradient(degree, direction, weight);
        return (d - direction * glm::dot(direction, d)) * sight.inverse_length;
    }

    /// A step that is left out (see `list_capacity`), or a gradient that is, says nothing of the Gaussian.
    WARPAGG_HD void note(const W& w, const value_t<W, unsigned>& i, const mask_t<W>& drawn,
                         const mask_t<W>& active, const vec2<real>& center) const {
        if (capacity.exceeded()) return;
        const vec2<real> halves(select(active, center.x * real(Real(camera.width) / 2), real(0)),
                                select(active, center.y * real(Real(camera.height) / 2), real(0)));
        const real most = largest(halves);
        const vec2<real> part = halves / select(most > real(0), most, real(1));
        const real norm = most * warpagg::math::sqrt(glm::dot(part, part));
        const mask_t<W> sound = drawn && is_finite(norm) && is_finite(halves.x) && is_finite(halves.y);
        auto* memory = reinterpret_cast<float*>(seen);
        const auto add = [&](unsigned field, const value_t<W, float>& x) {
            w.store(memory, 2 * i + field, w.load(memory, 2 * i + field, sound) + x, sound);
        };
        add(0, warpagg::math::convert<float>(norm));
        add(1, value_t<W, float>(1.0f));
    }
};

}  // namespace gs::raster
