// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/opacity.hpp"
#include "../model/parameters.hpp"
#include "camera.hpp"
#include "ellipse.hpp"

namespace gs::raster {

/// Gaussians nearer than this are not drawn.
inline constexpr double near_plane = 0.15;

/// Colours are held between 0 and this, so that their squares stay finite; photos end at 1.
inline constexpr double most_colour = 32768;

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
    vec3<Real> at;                 ///< in camera space
    Real u, v;                     ///< x/z and y/z, clamped for the Jacobian
    flag_of<Real> u_free, v_free;  ///< not clamped
    Real x, y;                     ///< the centre in pixels
    vec4<Real> turn;               ///< quaternion of length one
    Real inverse_length;           ///< of the quaternion
    vec3<Real> scale;
    mat3<Real> rotation;  ///< of the Gaussian
    vec3<Real> px, py;    ///< rows of Jacobian times world-to-camera rotation
    vec3<Real> ax, ay;    ///< rows of that times rotation times scale: the covariance is their Gram matrix
    ellipse<Real> shape;
    flag_of<Real> drawable;  ///< finite
};

/// Where a mean is in camera space. Nearer than `near_plane` it is not to be drawn.
template <class Real>
WARPAGG_HD vec3<Real> in_camera(const vec3<Real>& mean, const device_camera<Real>& camera) {
    return camera.rotation * mean + camera.translation;
}

/// `at`: the mean in camera space, beyond the near plane.
template <class Real>
WARPAGG_HD footprint<Real> see(const vec3<Real>& at, const vec3<Real>& log_scale,
                               const vec4<Real>& quaternion, const device_camera<Real>& camera) {
    using warpagg::math::max;
    using warpagg::math::min;
    footprint<Real> f;
    f.at = at;
    const unit<4, Real> turn(quaternion);
    f.turn = turn.direction;
    f.inverse_length = turn.inverse_length;
    for (int k = 0; k < 3; ++k) f.scale[k] = exponential(log_scale[k]);
    f.rotation = rotation_of(f.turn);

    const Real rz = 1 / f.at.z;
    const Real u = f.at.x / f.at.z, v = f.at.y / f.at.z;  // where 1 / z underflows, too
    f.u = min(max(u, camera.least_x), camera.most_x);
    f.v = min(max(v, camera.least_y), camera.most_y);
    f.u_free = f.u == u;
    f.v_free = f.v == v;
    f.x = camera.fx * u + camera.cx;
    f.y = camera.fy * v + camera.cy;
    // Row r of the world-to-camera rotation.
    const auto row = [&](int r) {
        return vec3<Real>(camera.rotation[0][r], camera.rotation[1][r], camera.rotation[2][r]);
    };
    f.px = camera.fx * rz * (row(0) - f.u * row(2));
    f.py = camera.fy * rz * (row(1) - f.v * row(2));
    // v * M is the row vector times the matrix.
    f.ax = (f.px * f.rotation) * f.scale;
    f.ay = (f.py * f.rotation) * f.scale;

    f.shape = ellipse<Real>(f.ax, f.ay);
    f.drawable =
        is_finite(f.at) && is_finite(f.x) && is_finite(f.y) && is_finite(log_scale) && f.shape.is_sound();
    return f;
}

}  // namespace gs::raster
