// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gs {

/// Inverse depths of a photo, as networks estimate them. Each map has its own `depth_fit`, which
/// maps a value to 1 / depth: see `camera::image_point`. Nearer points have larger values.
struct depth_map {
    int width = 0;
    int height = 0;
    std::vector<std::uint16_t> values;  ///< by rows from the top; 0 if unknown

    bool is_there() const { return width > 0; }
};

/// The line from values to inverse depths: inverse depth = scale * value + offset. A scale of zero
/// means that the line is unknown.
struct depth_fit {
    float scale = 0, offset = 0;
};

/// The meaning of the values in a file. `depth` is in any unit, the same for the whole file.
enum class depth_values { inverse_depth, depth };

/// Reads a depth map from a PNG with one channel, and scales it to the size of its photo. Throws
/// `error` with the file if it is not such a PNG, or if its aspect ratio differs by more than 3 %.
/// The tolerance exists because networks round sides to multiples of their patch size.
depth_map read_depth_map(const std::filesystem::path& file, int width, int height,
                         depth_values values = depth_values::inverse_depth);

/// Scales a depth map. Each pixel becomes the mean of the known values that it covers, including
/// fractions of pixels. It is unknown if they cover less than half of it.
depth_map resized(const depth_map& source, int width, int height);

}  // namespace gs
