// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "../core/log.hpp"
#include "../model/gaussians.hpp"

namespace gs {

struct scene;

/// Where coordinates are counted from, and in which unit: original = origin + scale * internal. The files of
/// a scene and of a model have the original ones; in between all is near zero and near one, so that float
/// suffices wherever the scene lies and whatever its unit.
struct frame {
    glm::dvec3 origin{0};
    double scale = 1;  ///< positive

    glm::dvec3 into(const glm::dvec3& original) const { return (original - origin) / scale; }
    glm::dvec3 out_of(const glm::dvec3& internal) const { return origin + scale * internal; }
};

/// The scene's extent in its internal frame: the near plane of the kernels, 0.15, is 3.75 % of it. One
/// farther off costs held-out views of sparsely photographed scenes some tenths of a dB; a nearer one,
/// others.
inline constexpr double internal_extent = 4;

/// Where the training cameras are: their mean is the origin, their extent `internal_extent`. The scale is
/// positive and finite for any finite cameras and points. Precondition: the scene is in its original frame.
frame frame_of(const scene& scene);

/// Where the Gaussians are, robust against floaters: the medians of their coordinates are the origin, half of
/// them reach (by a standard deviation) no farther than 1. Precondition: there is one.
frame frame_of(const gaussians& model);

/// Moves cameras and points from their original frame into `frame_of` it, and notes it in `scene.frame`.
/// Points farther off than 10^9 are left out, which is said through `log`.
void recentre(scene& scene, const log_function& log);

/// Means and scales in another frame, in double and rounded once; all else is the same in both.
gaussians into(const frame& frame, gaussians original);
gaussians out_of(const frame& frame, gaussians internal);

}  // namespace gs
