// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gs {

/// Inverse depths of a photo, as networks estimate them: a `depth_fit`, which each map has for
/// itself, turns a value into 1 / depth, see `camera::image_point`. Nearer points have larger
/// values.
struct depth_map {
    int width = 0;
    int height = 0;
    std::vector<std::uint16_t> values;  ///< row by row from the top; 0: unknown. Empty: no map

    bool is_there() const { return !values.empty(); }
};

/// Inverse depth = scale * value + offset. A scale of zero means that the fit is unknown.
struct depth_fit {
    float scale = 0, offset = 0;
};

/// Reads a depth map from a PNG with one channel, and scales it to the size of its photo. Throws
/// `error` with the file if it is not such a PNG, or if its aspect ratio differs by more than 3 %.
/// (Networks round sides to multiples of their patch size.)
depth_map read_depth_map(const std::filesystem::path& file, int width, int height);

/// Scales a depth map: each pixel is the mean of the known values that it covers, including
/// fractions of pixels, or unknown if they cover less than half of it.
depth_map resized(const depth_map& source, int width, int height);

}  // namespace gs
