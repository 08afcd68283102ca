// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../model/gaussians.hpp"
#include "../scene/scene.hpp"

namespace gs {

/// Returns one isotropic Gaussian per point, with the color of the point, opacity 0.1, and zero SH
/// coefficients above degree 0. Its scale is the root mean square distance to the 3 nearest other
/// points, or to all if there are fewer, and at least sqrt(1e-7) in internal coordinates. If there
/// are more than `most` points, uses a random sample of `most` points, which `seed` determines. Each
/// 128 consecutive Gaussians are close to each other in space, and any larger part has some of all places.
/// Precondition: there is at least one point.
gaussians from_points(std::vector<colored_point> points, int sh_degree, std::size_t most, std::uint64_t seed);

/// Returns `count` points of random color, uniform in a box, for scenes without points. If
/// `scene::object_centered` and the cameras look at a common point, the box is centered there, and
/// its half side is 1.3 / 4.03 of the median distance of the cameras, as in the NeRF-synthetic
/// scenes. Otherwise it is centered on the mean camera, and its half side is the extent of the
/// scene.
std::vector<colored_point> random_points(const scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace gs
