// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace gs {

/// 8-bit RGBA, rows from the top, colour premultiplied by alpha: what lies over a background b is
/// `colour + (1 - alpha) * b`, and an area average of premultiplied pixels is the average of what one sees.
/// What a mask leaves out is `left_out` (left_out.hpp).
struct image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height
    bool has_alpha = false;          ///< some pixel is not opaque, and no mask leaves it out
    bool has_mask = false;           ///< some pixel is left out

    bool leaves_out(std::size_t pixel) const {
        return has_mask && rgba[4 * pixel + 3] == 0 && rgba[4 * pixel] == 255;
    }
    bool leaves_all_out() const;
    void leave_out(std::size_t pixel);
    bool has_transparent_pixel() const;  ///< that is not left out
};

/// Reads a PNG or JPEG, told apart by its first bytes; grey, palette, 16-bit and CMYK-free JPEGs included.
/// Throws `error` naming the file where it is missing, unreadable, truncated, has no pixels, more than 65536
/// a side or 2 GiB of them, or more than 100 scans. Memory goes into pixels, up to 10 bytes each, and nothing
/// else.
image read_image(const std::filesystem::path& file);

/// The one channel of a PNG that has one, without alpha, rows from the top; what has fewer than 16 bit is
/// spread over them. Errors as `read_image`, and where it has more.
std::vector<std::uint16_t> read_grey_png(const std::filesystem::path& file, int& width, int& height);

/// Width and height from the header alone, without decoding. Errors as `read_image`.
void read_image_size(const std::filesystem::path& file, int& width, int& height);

/// Writes an opaque 8-bit RGB PNG from planar floats in [0, 1] (three planes of width*height), clamped and
/// rounded to nearest. Written aside and renamed: an existing file is never half replaced.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<float>& planes);

/// The area average: each output pixel is the mean of the input it covers, fractions of pixels included. Of
/// one with a mask, the mean of what is not left out; left out where that is less than half.
/// Precondition: 1 <= width <= source.width, and likewise the height.
image shrink(const image& source, int width, int height);

/// The image over a constant background, as planar floats in [0, 1]. What is left out is the background.
std::vector<float> over_background(const image& source, const float background[3]);

}  // namespace gs
