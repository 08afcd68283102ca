// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "photo_shifts.hpp"
#include "scene.hpp"

namespace gs {

/// The camera of a training photo with a corrected pose.
struct corrected_camera {
    gs::camera camera;
    /// Whether the photo shows the colors of points at their places. Otherwise, the pose is the given one, or
    /// a turn of it.
    bool is_aligned = true;
};

/// Corrects the poses of the training photos, if these are shifted against the points. Alternates between
/// the pose of each photo (see `fit_pose`) and the color of each point, which is its median over photos.
/// Starts from the colors of points that the scene has, and from a turn of each camera that its shift gives.
/// Points keep their positions. `shifts`: of all training photos. Works for all lenses. The result does not
/// depend on the number of threads. Cost: about that of four thousand projections of each of up to 6000
/// points, and up to half a megabyte of memory per photo.
std::vector<corrected_camera> correct_poses(const scene& of, const photo_shifts& shifts);

}  // namespace gs
