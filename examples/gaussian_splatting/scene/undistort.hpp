// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "scene.hpp"

namespace gs {

/// The distortion of a lens in COLMAP's OPENCV model, which includes its simpler models.
struct lens {
    double k1 = 0, k2 = 0;  ///< radial
    double p1 = 0, p2 = 0;  ///< tangential

    bool is_none() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0; }

    /// The distorted position of the ray through (x/z, y/z) in the image plane.
    glm::dvec2 distort(glm::dvec2 ray) const;

    /// The determinant of the derivative of `distort`. Where it is not positive, the image plane
    /// folds over.
    double area_scale(glm::dvec2 ray) const;
};

/// The pinhole camera with the same size and center that shows as much of the photo as possible,
/// but nothing outside of it. Its focal lengths are those of `taken_with` times one factor from 0.5
/// to 5. None if no such camera exists because the distortion is too strong.
std::optional<camera> undistorted_camera(const camera& taken_with, const lens& distortion);

/// The photo as the pinhole camera `wanted` would have taken it, with bilinear interpolation.
image undistort(const image& photo, const camera& taken_with, const lens& distortion, const camera& wanted);
/// The same for its depth map, from the nearest pixels.
depth_map undistort(const depth_map& depths, const camera& taken_with, const lens& distortion,
                    const camera& wanted);

}  // namespace gs
