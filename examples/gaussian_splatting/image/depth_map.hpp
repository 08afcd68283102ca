// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gs {

/// What a photo's depth map says, by pixel, rows from the top: the inverse of the depth, see
/// `camera::image_point`, up to a factor and an offset that each map has for itself, as networks estimate it
/// from one photo. What is nearer has more.
struct depth_map {
    int width = 0;
    int height = 0;
    std::vector<std::uint16_t> values;  ///< 0: not known. Empty: there is no map

    bool is_there() const { return !values.empty(); }
};

/// What makes inverse depths of a map's values. A scale of zero: nobody knows what does.
struct depth_fit {
    float scale = 0, offset = 0;
};

/// Reads a PNG of one channel, of 8 or 16 bit, and brings it to the size of its photo. Throws `error` naming
/// the file where it is none, or of another shape by more than 3 %: networks round sides to multiples of
/// theirs.
depth_map read_depth_map(const std::filesystem::path& file, int width, int height);

/// Each pixel is the mean of what it covers and is known, fractions of pixels included; not known where that
/// is less than half.
depth_map resized(const depth_map& source, int width, int height);

}  // namespace gs
