// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"
#include "synthetic_parameters.hpp"

namespace gs {

/// Returns the views of a synthetic scene without their photos, which are `size` pixels wide.
/// The cameras lie on a spiral and look at the origin. Panoramas are level and have any heading.
std::vector<view> synthetic_views(int size, const synthetic_parameters& how);

/// Returns the largest distance of such a camera from the origin.
double farthest_camera(const synthetic_parameters& how);

/// Turns each camera by `how.poses` degrees about a random axis, and moves it by `how.poses` percent of
/// the distance of the nearest cameras, in a random direction. `first`: number of the first view, from
/// which all random numbers follow.
void disturb_poses(std::vector<view>& views, std::size_t first, const synthetic_parameters& how);

}  // namespace gs
