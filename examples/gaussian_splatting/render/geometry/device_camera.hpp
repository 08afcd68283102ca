// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>

#include "../../core/error.hpp"
#include "../../core/lane_math.hpp"
#include "../../scene/camera.hpp"

namespace gs::raster {

/// Gaussians whose center has a smaller depth than this are not drawn. The depth is z for a pinhole
/// camera, and the distance from the camera for other lenses. In the unit of the model.
inline constexpr double near_plane = 0.15;

/// The camera parameters that kernels read. `Real` may be a SIMD value with equal lanes.
template <class Real>
struct device_camera {
    int width, height;
    Real fx, fy, cx, cy;
    glm::mat<3, 3, Real> rotation;
    glm::vec<3, Real> translation;
    glm::vec<3, Real> center;
    /// Bounds of x/z and y/z in the Jacobian of the projection: the image, extended on each side by
    /// 15 % of its width or height. They bound the affine approximation (Zwicker et al. 2001) of
    /// Gaussians far outside the image.
    Real least_x, most_x, least_y, most_y;
    /// The next three are used for fisheye lenses only.
    glm::vec<4, Real> bends;  ///< see `fisheye::k`
    Real least_cosine;        ///< cosine of the largest drawn angle: image corners plus margin
    Real end;                 ///< see `fisheye::end`

    /// Returns row r of the rotation: axis r of camera space in world coordinates.
    WARPAGG_HD glm::vec<3, Real> axis(int r) const {
        return {rotation[0][r], rotation[1][r], rotation[2][r]};
    }
};

/// Throws `error` if an image is too large: indices into its three planes must fit in 31 bits.
inline void require_drawable(const camera& view) {
    if (std::int64_t{view.width} * view.height > std::int64_t{1} << 29)
        throw error("an image of " + std::to_string(view.width) + "x" + std::to_string(view.height) +
                    " has more than 2^29 pixels: lower --resolution");
}

/// Converts a camera for kernels.
template <class Real>
device_camera<Real> for_device(const camera& c) {
    const double margin_x = 0.15 * c.width, margin_y = 0.15 * c.height;
    device_camera<Real> d{};
    d.width = c.width;
    d.height = c.height;
    d.fx = constant<Real>(c.fx);
    d.fy = constant<Real>(c.fy);
    d.cx = constant<Real>(c.cx);
    d.cy = constant<Real>(c.cy);
    d.rotation = glm::mat<3, 3, Real>(c.rotation);
    d.translation = glm::vec<3, Real>(c.translation);
    d.center = glm::vec<3, Real>(c.center());
    d.least_x = constant<Real>((-margin_x - c.cx) / c.fx);
    d.most_x = constant<Real>((c.width + margin_x - c.cx) / c.fx);
    d.least_y = constant<Real>((-margin_y - c.cy) / c.fy);
    d.most_y = constant<Real>((c.height + margin_y - c.cy) / c.fy);
    if (c.fisheye) {
        const auto& k = c.fisheye->k();
        d.bends = {constant<Real>(k[0]), constant<Real>(k[1]), constant<Real>(k[2]), constant<Real>(k[3])};
        d.end = constant<Real>(c.fisheye->end());
        const double across = std::max(margin_x + c.cx, c.width + margin_x - c.cx) / c.fx;
        const double down = std::max(margin_y + c.cy, c.height + margin_y - c.cy) / c.fy;
        d.least_cosine = constant<Real>(std::cos(c.fisheye->angle(std::hypot(across, down))));
    }
    return d;
}

}  // namespace gs::raster
