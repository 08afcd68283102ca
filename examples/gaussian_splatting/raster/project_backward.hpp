// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/spherical_harmonics.hpp"
#include "geometry.hpp"
#include "splat.hpp"

namespace gs::raster {

/// What the backward blending sums for a Gaussian over the pixels, with s = dL/dalpha alpha and d = pixel -
/// centre. A record is 12 values apart from the next, so that one commit touches two sectors.
enum sum { sum_red, sum_green, sum_blue, sum_s, sum_sx, sum_sy, sum_sxx, sum_sxy, sum_syy, sum_count };
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
    const splat<Real>* splats;
    const std::uint32_t* tiles;
    const Real* sums;  ///< `record_stride` a Gaussian

    parameter_arrays<Real> gradients;
    visibility* seen;  ///< null: nobody wants to know

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto i = static_cast<unsigned>(index);
        if (tiles[i] == 0) {
            clear(i);
            return;
        }
        const footprint<Real> f = see(gaussians, i, camera);
        const Real* s = sums + i * record_stride;
        // L depends on the exponent sigma through alpha = o exp(-sigma), so dL/dsigma = -s, where
        // sigma = (A dx^2 + C dy^2) / 2 + B dx dy and (A, B, C) is the inverse covariance.
        const Real inverse = 1 / f.determinant;
        const Real A = f.yy * inverse, B = -f.xy * inverse, C = f.xx * inverse;
        const vec2<Real> centre(A * s[sum_sx] + B * s[sum_sy], B * s[sum_sx] + C * s[sum_sy]);
        gradients.opacity[i] = s[sum_s] * (1 - splats[i].opacity);

        // dL/dcovariance = -Q G Q with Q the inverse covariance and G = dL/dQ = -1/2 sum s d d^T.
        const Real half(0.5);
        const Real gxx = half * s[sum_sxx], gxy = half * s[sum_sxy], gyy = half * s[sum_syy];
        const Real hxx = A * gxx + B * gxy, hxy = A * gxy + B * gyy, hyx = B * gxx + C * gxy,
                   hyy = B * gxy + C * gyy;
        const Real cxx = hxx * A + hxy * B, cxy = hxx * B + hxy * C, cyy = hyx * B + hyy * C;
        // The covariance is the Gram matrix of ax, ay.
        const vec3<Real> dax = Real(2) * (cxx * f.ax + cxy * f.ay);
        const vec3<Real> day = Real(2) * (cxy * f.ax + cyy * f.ay);

        shape(i, f, dax, day);
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
        for (int band = 0; band <= sh_degree; ++band) {
            const unsigned size = static_cast<unsigned>(2 * band + 1);
            for (unsigned m = 0; m < size; ++m) store3(gradients.sh[band], i * size + m, zero);
        }
    }

    /// ax = (px R) * scale: to the scale and, through R, to the quaternion.
    WARPAGG_HD void shape(unsigned i, const footprint<Real>& f, const vec3<Real>& dax,
                          const vec3<Real>& day) const {
        store3(gradients.log_scale, i, dax * f.ax + day * f.ay);
        const vec3<Real> sax = dax * f.scale, say = day * f.scale;
        mat3<Real> rotation;
        for (int c = 0; c < 3; ++c) rotation[c] = sax[c] * f.px + say[c] * f.py;
        const vec4<Real> unit = rotation_gradient(f.unit, rotation);
        // Only the part across the quaternion turns anything.
        const vec4<Real> q = (unit - f.unit * glm::dot(f.unit, unit)) * f.inverse_length;
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
        // A channel that the forward pass held at zero takes no gradient.
        const splat<Real>& p = splats[i];
        const vec3<Real> g(p.red > 0 ? s[sum_red] : Real(0), p.green > 0 ? s[sum_green] : Real(0),
                           p.blue > 0 ? s[sum_blue] : Real(0));
        const vec3<Real> sight = load3(gaussians.mean, i) - camera.centre;
        const Real inverse_length = 1 / glm::length(sight);
        const vec3<Real> direction = sight * inverse_length;
        Real basis[16], weight[16];
        sh_basis(sh_degree, direction, basis);
        for (int band = 0, k = 0; band <= sh_degree; ++band) {
            const unsigned size = static_cast<unsigned>(2 * band + 1);
            for (unsigned m = 0; m < size; ++m, ++k) {
                weight[k] = glm::dot(g, load3(gaussians.sh[band], i * size + m));
                store3(gradients.sh[band], i * size + m, basis[k] * g);
            }
        }
        const vec3<Real> d = sh_gradient(sh_degree, direction, weight);
        return (d - direction * glm::dot(direction, d)) * inverse_length;
    }

    WARPAGG_HD void note(unsigned i, const vec2<Real>& centre) const {
        const vec2<Real> halves(Real(0.5) * Real(camera.width), Real(0.5) * Real(camera.height));
        seen[i].gradient += static_cast<float>(glm::length(centre * halves));
        seen[i].seen += 1;
    }
};

}  // namespace gs::raster
