// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "../core/log.hpp"
#include "../model/gaussians.hpp"

namespace gs {

struct scene;

/// The similarity between world coordinates, which files contain, and internal coordinates: world =
/// origin + scale * internal. Internal coordinates are close to zero and to one in magnitude, so
/// float suffices for any location and unit of the scene.
struct normalization {
    glm::dvec3 origin{0};
    double scale = 1;  ///< positive

    glm::dvec3 to_internal(const glm::dvec3& world) const { return (world - origin) / scale; }
    glm::dvec3 to_world(const glm::dvec3& internal) const { return origin + scale * internal; }
};

/// The extent of a normalized scene. It determines the distance of the kernels' near plane, 0.15,
/// relative to the scene: 3.75 % of the extent. A farther plane would cut into sparsely
/// photographed scenes. A nearer one would leave floaters in front of cameras.
inline constexpr double internal_extent = 4;

/// Returns the normalization of the training cameras: their mean becomes the origin, and their
/// extent becomes `internal_extent`. The scale is positive and finite for all finite cameras and
/// points. Precondition: the scene is in world coordinates.
normalization normalization_of(const scene& scene);

/// Returns the normalization of a model without a scene, which is robust against floaters. The
/// medians of the coordinates become the origin. Half of the Gaussians, extended by one standard
/// deviation, then lie within distance 1. Precondition: the model is not empty.
normalization normalization_of(const gaussians& model);

/// Transforms cameras and points to internal coordinates, and stores the normalization in the
/// scene. Drops points at internal distances above 10^9, and reports their number to `log`.
void normalize(scene& scene, const log_function& log);

/// Transforms means and scales in double precision, and rounds the result once. All other
/// parameters are invariant.
/// @{
gaussians to_internal(const normalization& normalization, gaussians world);
gaussians to_world(const normalization& normalization, gaussians internal);
/// @}

}  // namespace gs
