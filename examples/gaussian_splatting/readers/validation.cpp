// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "validation.hpp"

#include <array>
#include <cmath>

namespace gs {

// Both are written so that NaN fails too.
bool has_valid_intrinsics(const camera& taken_with, const lens& distortion) {
    constexpr double least_focal_length = 1e-6, largest = 1e9;
    const auto k = taken_with.fisheye ? taken_with.fisheye->k() : std::array<double, 4>{};
    for (const double value : {taken_with.fx, taken_with.fy, taken_with.cx, taken_with.cy, distortion.k1,
                               distortion.k2, distortion.p1, distortion.p2, k[0], k[1], k[2], k[3]})
        if (!(std::abs(value) <= largest)) return false;
    return taken_with.fx >= least_focal_length && taken_with.fy >= least_focal_length;
}

bool is_valid_position(const glm::dvec3& position) {
    constexpr double farthest = 1e30;
    return std::abs(position.x) <= farthest && std::abs(position.y) <= farthest &&
           std::abs(position.z) <= farthest;
}

}  // namespace gs
