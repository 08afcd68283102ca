// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/spherical_harmonics.hpp"
#include "geometry.hpp"
#include "list_room.hpp"
#include "splat.hpp"

namespace gs::raster {

/// What the backward blending sums for a Gaussian over the pixels, with s = dL/dalpha alpha and (u, v) the
/// offset in widths of the splat (see `whitened`), in which a long thin splat's moments do not cancel. A
/// record is 12 values apart from the next, so that one commit touches two sectors.
enum sum { sum_red, sum_green, sum_blue, sum_s, sum_su, sum_sv, sum_suu, sum_suv, sum_svv, sum_count };
inline constexpr unsigned record_stride = 12;

/// What densification wants to know of a Gaussian, over the iterations since it last asked.
struct visibility {
    float gradient;  ///< sum of the norms of dL/d(centre), in halves of the picture's sides
    float seen;      ///< iterations in which it was drawn
};

/// From the sums over pixels to the gradients of the parameters: one index a Gaussian. Gradients of Gaussians
/// that are not drawn are zero.
template <class Real>
struct project_backward {
    parameter_arrays<const Real> gaussians;
    device_camera<Real> camera;
    int sh_degree;
    int learned_sh_degree;  ///< no gradients of bands above it
    const splat<Real>* splats;
    const std::uint32_t* tiles;
    const Real* sums;  ///< `record_stride` a Gaussian

    parameter_arrays<Real> gradients;
    visibility* seen;  ///< null: nobody wants to know
    list_room room;    ///< of the view

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        if (tiles[i] == 0) {
            clear(i);
            return;
        }
        const footprint<Real> f = see(gaussians, i, camera);
        const Real* s = sums + i * record_stride;
        // L depends on the exponent through alpha = o exp(-ln2 (u^2 + v^2)), and s = dL/dalpha alpha. With M
        // the rows (p, 0), (r, q), the inverse covariance is 2 ln2 M^T M and (u, v) = M d.
        constexpr Real two_ln2 = Real(1.3862943611198906);
        const Real p = f.shape.p, q = f.shape.q, r = f.shape.r;
        const vec2<Real> centre = two_ln2 * vec2<Real>(p * s[sum_su] + r * s[sum_sv], q * s[sum_sv]);
        gradients.opacity[i] = s[sum_s] * sigmoid(-gaussians.opacity[i]);

        // dL/dcovariance = (2 ln2)^2 / 2 M^T W M with W the second moments, and the covariance is the Gram
        // matrix of ax and ay, whose whitened forms are wx and wy.
        const vec3<Real> wx = p * f.ax, wy = r * f.ax + q * f.ay;
        const Real k = two_ln2 * two_ln2;
        const vec3<Real> nx = k * (s[sum_suu] * wx + s[sum_suv] * wy),
                         ny = k * (s[sum_suv] * wx + s[sum_svv] * wy);
        const vec3<Real> dax = p * nx + r * ny, day = q * ny;

        store3(gradients.log_scale, i, nx * wx + ny * wy);
        turn(i, f, dax * f.scale, day * f.scale);
        position(i, f, centre, f.rotation * (dax * f.scale), f.rotation * (day * f.scale), s);
        if (seen != nullptr) note(i, centre);
    }

  private:
    WARPAGG_HD void clear(unsigned i) const {
        const vec3<Real> zero(0);
        store3(gradients.mean, i, zero);
        store3(gradients.log_scale, i, zero);
        for (unsigned k = 0; k < 4; ++k) gradients.quaternion[4 * i + k] = 0;
        gradients.opacity[i] = 0;
        for (int band = 0; band <= learned_sh_degree; ++band) {
            const unsigned size = static_cast<unsigned>(2 * band + 1);
            for (unsigned m = 0; m < size; ++m) store3(gradients.sh[band], i * size + m, zero);
        }
    }

    /// ax = (px R) * scale: through R to the quaternion.
    WARPAGG_HD void turn(unsigned i, const footprint<Real>& f, const vec3<Real>& sax,
                         const vec3<Real>& say) const {
        mat3<Real> rotation;
        for (int c = 0; c < 3; ++c) rotation[c] = sax[c] * f.px + say[c] * f.py;
        const vec4<Real> g = rotation_gradient(f.turn, rotation);
        // Only the part across the quaternion turns anything.
        const vec4<Real> q = (g - f.turn * glm::dot(f.turn, g)) * f.inverse_length;
        for (int k = 0; k < 4; ++k) gradients.quaternion[4 * i + static_cast<unsigned>(k)] = q[k];
    }

    /// The mean moves the centre, the Jacobian and the direction that the colour is seen from.
    WARPAGG_HD void position(unsigned i, const footprint<Real>& f, const vec2<Real>& centre,
                             const vec3<Real>& dpx, const vec3<Real>& dpy, const Real* s) const {
        const Real rz = 1 / f.at.z;
        const auto row = [&](int r) {
            return vec3<Real>(camera.rotation[0][r], camera.rotation[1][r], camera.rotation[2][r]);
        };
        // px = fx / z (row 0 - u row 2), and u = x / z unless it is clamped.
        const Real du = -camera.fx * rz * glm::dot(dpx, row(2)), dv = -camera.fy * rz * glm::dot(dpy, row(2));
        vec3<Real> at(camera.fx * rz * centre.x, camera.fy * rz * centre.y, 0);
        at.z = -rz * (at.x * f.at.x + at.y * f.at.y) - rz * (glm::dot(dpx, f.px) + glm::dot(dpy, f.py));
        if (f.u_free) {
            at.x += du * rz;
            at.z -= du * f.u * rz;
        }
        if (f.v_free) {
            at.y += dv * rz;
            at.z -= dv * f.v * rz;
        }
        store3(gradients.mean, i, at * camera.rotation + colour(i, s));
    }

    /// Returns the gradient of the mean through the direction of sight.
    WARPAGG_HD vec3<Real> colour(unsigned i, const Real* s) const {
        // A channel that the forward pass held at a bound takes no gradient.
        const auto free = [](Real channel, Real g) {
            return channel > 0 && channel < Real(most_colour) ? g : Real(0);
        };
        const splat<Real>& p = splats[i];
        const vec3<Real> g(free(p.red, s[sum_red]), free(p.green, s[sum_green]), free(p.blue, s[sum_blue]));
        const unit<3, Real> sight(load3(gaussians.mean, i) - camera.centre);
        const vec3<Real> direction = sight.direction;
        Real basis[16], weight[16];
        sh_basis(sh_degree, direction, basis);
        for (int band = 0, k = 0; band <= sh_degree; ++band) {
            const unsigned size = static_cast<unsigned>(2 * band + 1);
            for (unsigned m = 0; m < size; ++m, ++k) {
                weight[k] = glm::dot(g, load3(gaussians.sh[band], i * size + m));
                if (band <= learned_sh_degree) store3(gradients.sh[band], i * size + m, basis[k] * g);
            }
        }
        const vec3<Real> d = sh_gradient(sh_degree, direction, weight);
        return (d - direction * glm::dot(direction, d)) * sight.inverse_length;
    }

    /// A step that is left out (see `list_room`), or a gradient that is, says nothing of the Gaussian.
    WARPAGG_HD void note(unsigned i, const vec2<Real>& centre) const {
        const vec2<Real> halves =
            centre * vec2<Real>(Real(0.5) * Real(camera.width), Real(0.5) * Real(camera.height));
        const Real most = largest(halves);
        const auto norm = static_cast<float>(most > 0 ? most * glm::length(halves / most) : most);
        if (room.exceeded() || !is_finite(norm) || !is_finite(halves.x) || !is_finite(halves.y)) return;
        seen[i].gradient += norm;
        seen[i].seen += 1;
    }
};

}  // namespace gs::raster
