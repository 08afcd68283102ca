// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "scene.hpp"

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

/// Returns the pinhole camera with the same size and center that shows as much of the photo as
/// possible, but nothing outside of it. Its focal lengths are those of `taken_with` times one
/// factor from 0.5 to 5. Returns nothing if the distortion is too strong for such a camera.
std::optional<camera> undistorted_camera(const camera& taken_with, const lens& distortion);

/// Resamples a photo to the pinhole camera `wanted`, with bilinear interpolation.
image undistort(const image& photo, const camera& taken_with, const lens& distortion, const camera& wanted);
/// Resamples a depth map from the nearest pixels.
depth_map undistort(const depth_map& depths, const camera& taken_with, const lens& distortion,
                    const camera& wanted);

}  // namespace gs
