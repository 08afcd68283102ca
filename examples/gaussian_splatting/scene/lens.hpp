// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>

namespace gs {

/// The distortion of a lens in OpenCV's model with three radial coefficients (Brown 1966). It
/// includes COLMAP's model OPENCV, which lacks k3.
struct lens {
    double k1 = 0, k2 = 0;  ///< radial
    double p1 = 0, p2 = 0;  ///< tangential
    double k3 = 0;          ///< radial

    bool is_none() const { return *this == lens{}; }
    bool operator==(const lens&) const = default;

    /// Returns the distorted position of the ray through (x/z, y/z) in the image plane.
    glm::dvec2 distort(glm::dvec2 ray) const;

    /// Returns the determinant of the derivative of `distort`. The image plane folds over where it
    /// is not positive.
    double area_scale(glm::dvec2 ray) const;
};

}  // namespace gs
