// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../reader.hpp"

namespace gs {

/// Generates ray-traced scenes: `synthetic:NAME[,PARAMETER=VALUE...]`. The parameters are the
/// members of `synthetic_parameters`. By default, cameras lie on the upper half of a sphere (z is
/// up), and shading does not depend on the viewing direction. All surfaces except walls lie within 1.3
/// of the origin along each axis.
///
///     spheres   patterned spheres in a pool of light on a dark ground, on black
///     alpha     spheres that float in front of a transparent background
///
/// There are 40 training and 8 test images, or 48 training images without `load_options::eval`.
/// They have 128x128 pixels, or 256x128 as panoramas, divided by the resolution. The points, about
/// 3000 by default, lie on surfaces that a training camera sees, but not on walls. The result does not
/// depend on the number of threads.
extern const reader synthetic_reader;

/// Returns the names that may follow "synthetic:".
std::vector<std::string> synthetic_scene_names();

/// Replaces the pixels of `views` with renders of the scene `name` from their cameras.
/// Preconditions: no camera is inside a sphere or outside the walls.
void photograph_synthetic(const std::string& name, std::vector<view>& views);

/// Returns `count` random surface points of the scene `name`. Precondition: some view sees a
/// surface.
std::vector<colored_point> synthetic_points(const std::string& name, const std::vector<view>& views,
                                            std::size_t count, std::uint64_t seed);

}  // namespace gs
