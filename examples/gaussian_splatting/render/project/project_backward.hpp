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

/// The sums over pixels that the backward pass computes for each Gaussian: the gradient of its
/// color, and the moments up to second order of s = alpha dL/dalpha over the offset (u, v). The
/// offset is in units of the splat's width (see `whitened`), so that the moments of long thin
/// splats do not cancel.
///
/// The record of a Gaussian begins every 12 values, so that a commit of floats touches two memory
/// sectors.
enum sum { sum_red, sum_green, sum_blue, sum_s, sum_su, sum_sv, sum_suu, sum_suv, sum_svv, sum_count };
inline constexpr unsigned record_stride = 12;
/// The index of an additional sum for depth maps: the gradient of the inverse depth.
inline constexpr unsigned sum_inverse_depth = sum_count;

/// The statistics of a Gaussian for densification, over the iterations since its last run.
struct visibility {
    float gradient;  ///< sum of |dL/d(center)|; a unit is half the image's width and height
    float seen;      ///< number of iterations in which it was drawn
};

/// A sink of `project_backward` that stores all gradients in arrays. Gaussians that take part in no
/// pixel get zeros.
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

/// Computes the gradients of all parameters from the sums over pixels. One Gaussian per lane. A
/// Gaussian takes part in the step if any of its sums is not zero; otherwise all of its gradients
/// are zero.
///
/// `Sink::for_row` returns a function that is called with the values and the gradients of a few
/// components at a time. It may change the parameters immediately, because all reads have happened.
/// If `Sink::takes_zeros`, it is also called for rows in which no Gaussian takes part. If
/// `Sink::idle`, the kernel does nothing. If the object that `Sink::for_row` returns has a member
/// `by_camera`, it gets what determines the gradient of the camera's pose: the offset of the mean from
/// the camera's center, the gradients of the mean without and with the one through its color, and the
/// quaternion with its gradient. If it has a member `by_motion`, it gets the position of the mean in
/// camera space, the gradient of its velocity there, and the one of the time for reading a photo.
template <class W, class Real, class Sink, effect_set Effects>
struct project_backward {
    using real = value_t<W, Real>;

    parameter_arrays<const Real> gaussians;
    std::size_t count;
    camera_type<real, Effects> camera;
    int sh_degree;
    int learned_sh_degree;  ///< largest SH degree with gradients
    const splat<Real>* splats;
    const std::uint32_t* tiles;
    const Real* sums;  ///< `record_stride` values per Gaussian
    Sink sink;
    visibility* seen;        ///< may be null
    list_capacity capacity;  ///< capacity for the lists of the view

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
    /// Loads the sum of the inverse depth. Returns the lanes in which it is not zero.
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
        // The loss depends on the exponent through alpha = o exp(-ln2 (u^2 + v^2)), and
        // s = alpha dL/dalpha. Let M have the rows (p, 0) and (r, q). Then the inverse covariance
        // is 2 ln2 M^T M, and (u, v) = M d for the offset d.
        const real two_ln2 = constant<real>(1.3862943611198906);
        const real p = f.shape.p, q = f.shape.q, r = f.shape.r;
        const vec2<real> center = two_ln2 * vec2<real>(p * s[sum_su] + r * s[sum_sv], q * s[sum_sv]);

        // dL/dcovariance = (2 ln2)^2 / 2 M^T W M with the matrix W of second moments. The
        // covariance is the Gram matrix of ax and ay plus the pixel filter, and `axes` are ax and
        // ay multiplied by M.
        const whitened_axes<real> axes(f.shape, f.ax, f.ay);
        const real k = two_ln2 * two_ln2;
        vec3<real> nx = k * (s[sum_suu] * axes.x + s[sum_suv] * axes.y),
                   ny = k * (s[sum_suv] * axes.x + s[sum_svv] * axes.y);
        if constexpr (Effects.antialiasing) add_opacity_left_gradient(axes, s[sum_s], nx, ny);
        if constexpr (Effects.motion)
            f.motion.template add_opacity_left_gradient<Effects>(f.shape, f.ax, f.ay, axes, s[sum_s], nx, ny);
        const vec3<real> dax = p * nx + r * ny, day = q * ny;

        // The mean affects the center, the Jacobian, the depth and the direction for the color.
        vec3<real> by_position = f.seen.position_gradient(center, f.rotation * (dax * f.scale),
                                                          f.rotation * (day * f.scale), camera);
        if constexpr (Effects.motion) by_position += through_motion(put, f, center, s);
        if constexpr (Effects.depth)
            by_position += f.seen.inverse_depth_gradient(s[sum_inverse_depth], camera);
        put(parameter::log_scale, 0, 3, log_scale, nx * axes.x + ny * axes.y);
        const vec4<real> by_quaternion = turn(f, dax * f.scale, day * f.scale);
        put(parameter::quaternion, 0, 4, quaternion, by_quaternion);
        // mutate: one_minus_opacity_rounded
        put(parameter::opacity, 0, 1, opacity, glm::vec<1, real>(s[sum_s] * sigmoid(-opacity.x)));
        const vec3<real> by_mean = by_position + color(w, row, put, i, mean, s);
        put(parameter::mean, 0, 3, mean, by_mean);
        if constexpr (requires { &decltype(put)::by_camera; })
            put.by_camera(mean - camera.center, by_position, by_mean, quaternion, by_quaternion);
        return center;
    }

    /// Returns the gradient of the mean through the motion of its splat. `center`: gradient of the
    /// center.
    template <class Put>
    WARPAGG_HD vec3<real> through_motion(const Put& put, const footprint<real, Effects>& f,
                                         const vec2<real>& center, const real* s) const {
        const vec2<real> by_blur =
            f.motion.blur_gradient(f.shape, s[sum_s], s[sum_suu], s[sum_suv], s[sum_svv]);
        const auto g = f.motion.gradient(center, by_blur, f.seen, camera);
        if constexpr (requires { &Put::by_motion; }) put.by_motion(f.seen.at, g.by_velocity, g.by_readout);
        return f.seen.position_gradient(g.by_center, g.by_pixels.x * f.motion.velocity,
                                        g.by_pixels.y * f.motion.velocity, camera) +
               glm::cross(g.by_velocity, camera.turn) * camera.rotation;
    }

    /// Returns the gradient with respect to the quaternion, through the rotation R in
    /// ax = (px R) * scale. `sax` and `say` are the gradients with respect to px R and py R.
    static WARPAGG_HD vec4<real> turn(const footprint<real, Effects>& f, const vec3<real>& sax,
                                      const vec3<real>& say) {
        mat3<real> rotation;
        for (int c = 0; c < 3; ++c) rotation[c] = sax[c] * f.seen.px + say[c] * f.seen.py;
        const vec4<real> g = rotation_gradient(f.turn, rotation);
        // Removes the component along the quaternion, because normalization cancels its effect.
        return (g - f.turn * glm::dot(f.turn, g)) * f.inverse_length;
    }

    /// Passes the gradients of the SH coefficients to `put`. Returns the gradient of the mean
    /// through the direction.
    template <class Put>
    WARPAGG_HD vec3<real> color(const W& w, const gaussian_row<W>& row, const Put& put,
                                const value_t<W, unsigned>& i, const vec3<real>& mean, const real* s) const {
        // A channel that the forward pass clamped has no gradient.
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
        const std::uint32_t cache_slot = degree > 0 ? row.cache_slot(gaussians) : 0;
        WARPAGG_UNROLL
        for (int band = 0; band < 4; ++band) {
            if (band > degree) break;
            const int size = 2 * band + 1;
            const row_place<W> at(row, sh_band(band), cache_slot);
            WARPAGG_UNROLL
            for (int m = 0; m < size; ++m) {
                const int k = band * band + m;
                const std::size_t component = static_cast<std::size_t>(3 * m),
                                  width = static_cast<std::size_t>(3 * size);
                const auto value = at.row.template load<3>(w, at.array(gaussians), component, width);
                weight[k] = glm::dot(g, value);
                if (band <= learned_sh_degree) put(sh_band(band), component, width, value, basis[k] * g);
            }
        }
        const vec3<real> d = sh_gradient(degree, direction, weight);
        return (d - direction * glm::dot(direction, d)) * sight.inverse_length;
    }

    /// Adds to the statistics, except in skipped steps (see `list_capacity`) and for gradients that
    /// are not finite.
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
