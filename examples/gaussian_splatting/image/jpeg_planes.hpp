// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace gs {

/// The samples of a JPEG as cameras write it: one value of brightness per pixel, and two values of
/// color per two or four pixels. They are 1.5 or 2 bytes per pixel, while RGBA are 4.
struct jpeg_planes {
    int width = 0;
    int height = 0;
    bool has_half_height_colors = true;  ///< one color for 2 x 2 pixels (4:2:0), or for 2 x 1 (4:2:2)
    std::vector<std::uint8_t> samples;   ///< planes Y, Cb and Cr, in whole blocks of 8 x 8 values

    std::size_t bytes() const;
};

/// Returns the size of the samples of a file, or 0 if it is not a JPEG with such samples. Reads the
/// header only. Throws `error` like `read_image`.
std::size_t jpeg_plane_bytes(const std::filesystem::path& file);

/// Reads the samples of a JPEG, and reuses the memory of `planes`. Throws `error` like `read_image`.
/// Precondition: `jpeg_plane_bytes` is not 0.
void read_jpeg_planes(const std::filesystem::path& file, jpeg_planes& planes);

/// Converts samples to the RGBA pixels that `read_image` returns for the file, bit for bit:
/// interpolates colors with weights of 3/4 and 1/4 along each halved axis, and applies the matrix of
/// ITU-T T.871 (section 7), both in the integers of libjpeg-turbo. Precondition: `rgba` has space for
/// 4 * width * height bytes.
void to_rgba(const jpeg_planes& planes, std::uint8_t* rgba);

}  // namespace gs
