// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "camera.hpp"

namespace gs {

/// Returns the squared distance, in pixels, from the principal point of a camera to the farthest corner of
/// its image.
inline double square_of_farthest_corner(const camera& c) {
    const double x = std::max(c.cx, c.width - c.cx), y = std::max(c.cy, c.height - c.cy);
    return x * x + y * y;
}

/// Returns the squared distance of pixel coordinates from the principal point, relative to that of the
/// farthest corner. It is from 0 to 1 in the image. It has no meaning for panoramas.
inline double square_radius(const camera& c, double x, double y) {
    return ((x - c.cx) * (x - c.cx) + (y - c.cy) * (y - c.cy)) / square_of_farthest_corner(c);
}

}  // namespace gs
