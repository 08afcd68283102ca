// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "../core/log.hpp"
#include "../model/gaussians.hpp"

namespace gs {

struct scene;

/// The similarity between world coordinates, which files contain, and internal coordinates, which
/// are near zero and near one, so that float suffices wherever the scene lies and whatever its
/// unit: world = origin + scale * internal.
struct normalization {
    glm::dvec3 origin{0};
    double scale = 1;  ///< positive

    glm::dvec3 to_internal(const glm::dvec3& world) const { return (world - origin) / scale; }
    glm::dvec3 to_world(const glm::dvec3& internal) const { return origin + scale * internal; }
};

/// The extent of a normalized scene. The near plane of the kernels, 0.15, is 3.75 % of it: a
/// farther one cuts into sparsely photographed scenes, a nearer one leaves floaters in front of
/// cameras.
inline constexpr double internal_extent = 4;

/// The normalization of the training cameras: their mean becomes the origin, and their extent
/// `internal_extent`. The scale is positive and finite for all finite cameras and points.
/// Precondition: the scene is in world coordinates.
normalization normalization_of(const scene& scene);

/// The normalization of a model without a scene, robust against floaters: the medians of the
/// coordinates become the origin, and half of the Gaussians reach (by one standard deviation) no
/// farther than 1. Precondition: the model is not empty.
normalization normalization_of(const gaussians& model);

/// Transforms cameras and points to internal coordinates, and stores the normalization in the
/// scene. Drops points at internal distances beyond 10^9, and reports their number to `log`.
void normalize(scene& scene, const log_function& log);

/// Transform means and scales, in double precision and rounded once. All other parameters are
/// invariant.
/// @{
gaussians to_internal(const normalization& normalization, gaussians world);
gaussians to_world(const normalization& normalization, gaussians internal);
/// @}

}  // namespace gs
