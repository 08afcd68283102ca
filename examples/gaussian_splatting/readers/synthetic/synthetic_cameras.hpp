// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"
#include "synthetic_parameters.hpp"

namespace gs {

/// The width of photos whose size is not given.
inline constexpr int synthetic_size = 128;

/// Returns the views of a synthetic scene without their photos, which are `size` pixels wide.
/// The cameras lie on a spiral and look at the origin. Panoramas are level and have any heading.
std::vector<view> synthetic_views(int size, const synthetic_parameters& how);

/// Returns the largest distance of such a camera from the origin.
double farthest_camera(const synthetic_parameters& how);

/// Sets the motion of each camera while it takes its photo. The motion moves the center of the image by
/// up to `how.blur` pixels during the exposure, and by up to `how.shutter` pixels from the first row to the
/// last, if the image is `synthetic_size` pixels wide. Directions are random. Lengths are uniform, except
/// that every fourth camera keeps still. The camera also rolls and shifts a little.
void shake_cameras(std::vector<view>& views, const synthetic_parameters& how);

/// Returns the camera at a time while it takes its photo, from the middle of the exposure of the middle
/// row.
camera at_time(const camera& moving, double time);

/// Turns each camera by `how.poses` degrees about a random axis, and moves it by `how.poses` percent of
/// the distance of the nearest cameras, in a random direction. `first`: number of the first view, from
/// which all random numbers follow.
void disturb_poses(std::vector<view>& views, std::size_t first, const synthetic_parameters& how);

}  // namespace gs
