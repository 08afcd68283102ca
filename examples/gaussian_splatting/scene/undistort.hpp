// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "lens.hpp"
#include "scene.hpp"

namespace gs {

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
