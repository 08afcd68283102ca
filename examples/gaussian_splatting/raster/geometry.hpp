// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "../model/parameters.hpp"
#include "camera.hpp"

namespace gs::raster {

template <class Real>
using vec2 = glm::vec<2, Real>;
template <class Real>
using vec3 = glm::vec<3, Real>;
template <class Real>
using vec4 = glm::vec<4, Real>;
template <class Real>
using mat3 = glm::mat<3, 3, Real>;

/// Pixels; what the covariance of a splat is widened by, the variance of a pixel's filter (Kerbl et al.
/// 2023).
inline constexpr double pixel_variance = 0.3;
/// Gaussians nearer than this are not drawn.
inline constexpr double near_plane = 0.2;

template <class Real>
WARPAGG_HD vec3<Real> load3(const Real* p, unsigned i) {
    return {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
}
template <class Real>
WARPAGG_HD void store3(Real* p, unsigned i, const vec3<Real>& v) {
    p[3 * i] = v.x;
    p[3 * i + 1] = v.y;
    p[3 * i + 2] = v.z;
}

/// The rotation of a unit quaternion w x y z; columns are the principal axes.
template <class Real>
WARPAGG_HD mat3<Real> rotation_of(const vec4<Real>& q) {
    const Real w = q.x, x = q.y, y = q.z, z = q.w;
    return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
            2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
            2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
}

/// The gradient by the quaternion's components of sum(g * rotation_of(q)), element by element.
template <class Real>
WARPAGG_HD vec4<Real> rotation_gradient(const vec4<Real>& q, const mat3<Real>& g) {
    const Real w = q.x, x = q.y, y = q.z, z = q.w;
    // g[c][r] belongs to column c, row r.
    return Real(2) * vec4<Real>(z * (g[0][1] - g[1][0]) + y * (g[2][0] - g[0][2]) + x * (g[1][2] - g[2][1]),
                                y * (g[0][1] + g[1][0]) + z * (g[0][2] + g[2][0]) + w * (g[1][2] - g[2][1]) -
                                    2 * x * (g[1][1] + g[2][2]),
                                x * (g[0][1] + g[1][0]) + z * (g[1][2] + g[2][1]) + w * (g[2][0] - g[0][2]) -
                                    2 * y * (g[0][0] + g[2][2]),
                                x * (g[0][2] + g[2][0]) + y * (g[1][2] + g[2][1]) + w * (g[0][1] - g[1][0]) -
                                    2 * z * (g[0][0] + g[1][1]));
}

/// How a camera sees a Gaussian: all that both directions of the chain rule need.
template <class Real>
struct footprint {
    vec3<Real> at;        ///< in camera space
    Real u, v;            ///< x/z and y/z, clamped for the Jacobian
    bool u_free, v_free;  ///< not clamped
    vec4<Real> unit;      ///< quaternion of length one
    Real inverse_length;  ///< of the quaternion
    vec3<Real> scale;
    mat3<Real> rotation;  ///< of the Gaussian
    vec3<Real> px, py;    ///< rows of Jacobian times world-to-camera rotation
    vec3<Real> ax, ay;    ///< rows of that times rotation times scale: the covariance is their Gram matrix
    Real xx, xy, yy;      ///< covariance in pixels, widened
    Real determinant;
    bool drawable;  ///< in front of the camera, finite, not degenerate
};

template <class Real>
WARPAGG_HD footprint<Real> see(const parameter_arrays<const Real>& g, unsigned i,
                               const device_camera<Real>& camera) {
    using warpagg::math::max;
    using warpagg::math::min;
    footprint<Real> f;
    f.drawable = false;
    f.at = camera.rotation * load3(g.mean, i) + camera.translation;
    if (!(f.at.z > Real(near_plane))) return f;

    const vec4<Real> q(g.quaternion[4 * i], g.quaternion[4 * i + 1], g.quaternion[4 * i + 2],
                       g.quaternion[4 * i + 3]);
    const Real length2 = glm::dot(q, q);
    if (!(length2 > 0)) return f;
    f.inverse_length = 1 / warpagg::math::sqrt(length2);
    f.unit = q * f.inverse_length;
    f.scale = glm::exp(load3(g.log_scale, i));
    f.rotation = rotation_of(f.unit);

    const Real rz = 1 / f.at.z;
    const Real u = f.at.x * rz, v = f.at.y * rz;
    f.u = min(max(u, camera.least_x), camera.most_x);
    f.v = min(max(v, camera.least_y), camera.most_y);
    f.u_free = f.u == u;
    f.v_free = f.v == v;
    // Row r of the world-to-camera rotation.
    const auto row = [&](int r) {
        return vec3<Real>(camera.rotation[0][r], camera.rotation[1][r], camera.rotation[2][r]);
    };
    f.px = camera.fx * rz * (row(0) - f.u * row(2));
    f.py = camera.fy * rz * (row(1) - f.v * row(2));
    // v * M is the row vector times the matrix.
    f.ax = (f.px * f.rotation) * f.scale;
    f.ay = (f.py * f.rotation) * f.scale;

    const Real xx = glm::dot(f.ax, f.ax), yy = glm::dot(f.ay, f.ay);
    f.xy = glm::dot(f.ax, f.ay);
    f.xx = xx + Real(pixel_variance);
    f.yy = yy + Real(pixel_variance);
    // The determinant of a Gram matrix is a square (Lagrange's identity), so nothing cancels and none is
    // negative.
    const vec3<Real> area = glm::cross(f.ax, f.ay);
    f.determinant =
        glm::dot(area, area) + Real(pixel_variance) * (xx + yy) + Real(pixel_variance * pixel_variance);
    f.drawable = f.determinant > 0 && f.determinant < Real(1e30);
    return f;
}

template <class Real>
WARPAGG_HD Real sigmoid(Real x) {
    return 1 / (1 + glm::exp(-x));
}

}  // namespace gs::raster
