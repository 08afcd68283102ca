// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include "camera.hpp"

namespace gs {

/// Returns the pinhole camera with the pose of `c`, for programs that draw no other lens. It keeps
/// the intrinsics, except that it shows 60 degrees of the height of a panorama.
inline camera perspective_of(const camera& c) {
    camera pinhole = c;
    pinhole.fisheye.reset();
    if (!c.is_panorama) return pinhole;
    pinhole.is_panorama = false;
    pinhole.fx = pinhole.fy = 0.5 * c.height / std::tan(std::numbers::pi / 6);
    return pinhole;
}

}  // namespace gs
