// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "scene.hpp"

namespace gs {

/// How a lens bends the image plane: COLMAP's OPENCV model, of which its simpler ones are special cases.
struct lens {
    double k1 = 0, k2 = 0;  ///< radial
    double p1 = 0, p2 = 0;  ///< tangential

    bool is_straight() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0; }

    /// Where the ray through (x/z, y/z) meets the image plane.
    glm::dvec2 distort(glm::dvec2 ray) const;

    /// The determinant of distort's derivative: where it is not positive the image plane has folded over.
    double stretch(glm::dvec2 ray) const;
};

/// The pinhole camera that sees, at the same size and centre, as much of the photo as it can without a pixel
/// from outside of it: the focal lengths are `taken_with`'s times one factor. Nothing if the lens bends the
/// photo so much that there is no such camera within a factor of 5.
std::optional<camera> straightened(const camera& taken_with, const lens& distortion);

/// The photo as the pinhole camera `wanted` would have taken it, interpolated bilinearly.
image undistort(const image& photo, const camera& taken_with, const lens& distortion, const camera& wanted);
/// The same of its depth map, by the nearest pixels.
depth_map undistort(const depth_map& depths, const camera& taken_with, const lens& distortion,
                    const camera& wanted);

}  // namespace gs
