// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "../scene/scene.hpp"

namespace gs {

/// Returns for each point the mean squared distance to its `neighbors` nearest other points, or to all if
/// there are fewer; 0 for a single point. Uses all cores. Time: O(n log n). Memory: about 90 bytes for each
/// point. Preconditions: `neighbors` is at most `most_neighbors`, and there are 1 to 2^32 - 1 points.
/// @{
inline constexpr std::size_t most_neighbors = 3;
std::vector<double> neighbor_distances(const std::vector<colored_point>& points, std::size_t neighbors);
/// @}

}  // namespace gs
