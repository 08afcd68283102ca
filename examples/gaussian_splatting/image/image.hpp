// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace gs {

/// An 8-bit RGBA image, row by row from the top. Colors are premultiplied by alpha: over a
/// background b a pixel shows `color + (1 - alpha) * b`, and the average of premultiplied pixels is
/// what one sees from afar. A pixel that a mask excludes has the value `masked_pixel`.
struct image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height
    bool has_alpha = false;          ///< some pixel is not opaque and not masked
    bool has_mask = false;           ///< some pixel is masked

    bool is_masked(std::size_t pixel) const {
        return has_mask && rgba[4 * pixel + 3] == 0 && rgba[4 * pixel] == 255;
    }
    bool is_all_masked() const;
    void mask_pixel(std::size_t pixel);
    bool has_transparent_pixel() const;  ///< masked pixels do not count
};

/// Reads a PNG or JPEG of any color type except CMYK; the first bytes decide which of the two it
/// is. Throws `error` with the file if it is missing, truncated, malformed or empty, or has more
/// than 65536 pixels per side, 2 GiB of pixels, or 100 scans. Allocates at most 10 bytes per pixel.
image read_image(const std::filesystem::path& file);

/// Reads a PNG with one channel, row by row from the top. Values of fewer than 16 bits are scaled
/// to 16 bits. Throws `error` as `read_image` does, and if the file has more channels.
std::vector<std::uint16_t> read_gray_png(const std::filesystem::path& file, int& width, int& height);

/// Reads width and height from the header, without decoding. Throws `error` as `read_image` does.
void read_image_size(const std::filesystem::path& file, int& width, int& height);

/// Writes an opaque 8-bit RGB PNG. `planes` holds three planes of width * height values, which are
/// clamped to [0, 1] and rounded to nearest. See `atomic_file_write` for errors.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<float>& planes);

/// Averages over areas: each output pixel is the mean of the input that it covers, including
/// fractions of pixels. Masked pixels do not count; an output pixel is masked if they cover more
/// than half of it. Precondition: 1 <= width <= source.width, and likewise the height.
image downsample(const image& source, int width, int height);

/// The image over a constant background, as three planes of values in [0, 1]. Masked pixels show
/// the background.
std::vector<float> over_background(const image& source, const float background[3]);

}  // namespace gs
