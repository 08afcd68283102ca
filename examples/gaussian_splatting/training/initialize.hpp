// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../model/gaussians.hpp"
#include "../scene/scene.hpp"

namespace gs {

/// One Gaussian a point: isotropic, as wide as the root mean square distance to the 3 nearest other points,
/// opacity 0.1, color of the point, higher SH zero. Precondition: at least one point.
/// Where there are fewer than 3 other points, those there are count; a width is at least sqrt(1e-7), also
/// that of points that coincide and of a lone one, which is little in the internal frame of a scene. At most
/// `most` points, drawn without replacement by `seed` where there are more.
gaussians from_points(const std::vector<colored_point>& points, int sh_degree, std::size_t most,
                      std::uint64_t seed);

/// `count` points, uniform in the box that the cameras look at. For a Blender or synthetic scene it lies
/// about `looked_at`, and its half side is 1.3 where the cameras are 4.03 from that (the median), as in the
/// NeRF-synthetic scenes. Else, and where they look at nothing together, it is centerd on the mean of the
/// cameras with the scene's extent as half side. Colors are random. What `from_points` starts from where a
/// scene has no points.
std::vector<colored_point> random_points(const scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace gs
