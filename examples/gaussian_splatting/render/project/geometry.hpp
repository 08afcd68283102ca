// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../model/opacity.hpp"
#include "../../model/parameters.hpp"
#include "../geometry/device_camera.hpp"
#include "../geometry/ellipse.hpp"
#include "projection.hpp"
#include "splat_motion.hpp"

namespace gs::raster {

/// The upper bound to which colors are clamped, so that their squares stay finite. The lower bound
/// is 0, and the colors of photos are at most 1.
inline constexpr double most_color = 32768;

/// Returns the rotation matrix of a unit quaternion (w, x, y, z). Its columns are the principal
/// axes.
template <class Real>
WARPAGG_HD mat3<Real> rotation_of(const vec4<Real>& q) {
    const Real w = q.x, x = q.y, y = q.z, z = q.w;
    return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
            2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
            2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
}

/// Returns the gradient of the sum of g * rotation_of(q) over all elements, with respect to q.
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

/// The projection of a Gaussian, with all intermediate values that the forward and the backward
/// pass share.
template <class Real, effect_set Effects>
struct footprint {
    projection_of<Real, Effects> seen;
    vec4<Real> turn;      ///< the normalized quaternion
    Real inverse_length;  ///< inverse length of the quaternion
    vec3<Real> scale;
    mat3<Real> rotation;  ///< rotation of the Gaussian
    /// The rows of the Jacobian times rotation times scale. Their Gram matrix is the covariance in
    /// pixels.
    vec3<Real> ax, ay;
    ellipse<Real> shape;
    flag_of<Real> drawable;  ///< whether all values are finite
    [[no_unique_address]] motion_of_splat<Real, Effects> motion;

    /// `at`: the mean in camera space. Values are valid only if `projection_of::is_drawn`.
    WARPAGG_HD footprint(const vec3<Real>& at, const vec3<Real>& log_scale, const vec4<Real>& quaternion,
                         const camera_type<Real, Effects>& camera)
        : seen(at, camera) {
        const unit<4, Real> unit_turn(quaternion);
        turn = unit_turn.direction;
        inverse_length = unit_turn.inverse_length;
        for (int k = 0; k < 3; ++k) scale[k] = exponential(log_scale[k]);
        rotation = rotation_of(turn);
        // In GLM, v * M is the product of a row vector and a matrix.
        ax = (seen.px * rotation) * scale;
        ay = (seen.py * rotation) * scale;
        shape = ellipse<Real>(ax, ay);
        if constexpr (Effects.motion) move(camera);
        drawable = is_finite(at) && is_finite(seen.x) && is_finite(seen.y) && is_finite(log_scale) &&
                   shape.is_sound();
    }

  private:
    WARPAGG_HD void move(const moving_camera<Real>& camera) {
        motion = splat_motion<Real>(seen, camera);
        shape = motion.blurred(ax, ay);
        seen.x += motion.moved.x;
        seen.y += motion.moved.y;
    }
};

/// Transforms a mean to camera space.
template <class Real>
WARPAGG_HD vec3<Real> in_camera(const vec3<Real>& mean, const device_camera<Real>& camera) {
    return camera.rotation * mean + camera.translation;
}

}  // namespace gs::raster
