// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gs {

/// An 8-bit RGBA image, row by row from the top. Colors are premultiplied by alpha. Over a
/// background b, a pixel shows `color + (1 - alpha) * b`, and premultiplied pixels can be averaged
/// without weights. A masked pixel has the value `masked_pixel`.
struct image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height
    bool has_alpha = false;          ///< whether a pixel is neither opaque nor masked
    bool has_mask = false;           ///< whether a pixel is masked

    bool is_masked(std::size_t pixel) const {
        return has_mask && rgba[4 * pixel + 3] == 0 && rgba[4 * pixel] == 255;
    }
    bool is_all_masked() const;
    void mask_pixel(std::size_t pixel);
    bool has_transparent_pixel() const;  ///< masked pixels do not count
};

/// Returns the formats that `read_image` reads, for messages: "PNG or JPEG".
std::string image_formats();

/// Returns the usual endings of files of these formats, in lower case, such as ".png".
std::vector<std::string_view> image_endings();

/// How stored pixels become an upright image, as EXIF data specifies it. First mirrors the stored
/// image, then turns its rows into columns.
struct orientation {
    bool swaps_sides = false;  ///< rows become columns, so width and height are exchanged
    bool mirrors_x = false;    ///< exchanges left and right of the stored image
    bool mirrors_y = false;    ///< exchanges top and bottom of the stored image
    bool operator==(const orientation&) const = default;
};

/// The size of an image as its file stores it, and the orientation in its EXIF data.
struct image_header {
    int width = 0;
    int height = 0;
    orientation turn;
};

/// Reads an image as its file stores it: turn it upright with `turned_upright`. HEIF files specify
/// rotations of their own, which are applied. The first bytes determine the format. Throws `error`
/// with the file if it is missing, truncated, malformed or empty, or if it has more than 65536
/// pixels per side, 2 GiB of pixels, or 100 scans. Allocates at most 10 bytes per pixel, or about 20
/// for HEIF, whose decoders trust the size of the coded image before it is compared with the header.
image read_image(const std::filesystem::path& file);
/// Like the function above, but reuses the memory of `pixels`, whose content is lost also on errors.
void read_image(const std::filesystem::path& file, image& pixels);

/// Reads a PNG with one channel, row by row from the top. Scales values of fewer than 16 bits to 16
/// bits. Throws `error` like `read_image`, and if the file has more channels.
std::vector<std::uint16_t> read_gray_png(const std::filesystem::path& file, int& width, int& height);

/// Reads the header, without decoding. Throws `error` like `read_image`.
image_header read_image_header(const std::filesystem::path& file);

/// Reads the size of the upright image, without decoding. Throws `error` like `read_image`.
void read_image_size(const std::filesystem::path& file, int& width, int& height);

/// Returns the image in upright orientation. Needs as much memory as the image.
image turned_upright(const image& stored, const orientation& turn);

/// Returns 255 times a value, clamped to [0, 255] and rounded to nearest. Returns 0 for NaN.
std::uint8_t to_byte(float value);

/// Returns three planes as 8-bit RGB, row by row from the top, with values that `to_byte` converts.
std::vector<std::uint8_t> interleaved(const std::vector<float>& planes);

/// Writes an opaque 8-bit RGB PNG. `planes` holds three planes of width * height values, which
/// `to_byte` converts. Throws `error` like `atomic_file_write`.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<float>& planes);

/// Returns an 8-bit RGB image, row by row from the top, as a JPEG. `quality` is from 1 to 100, as
/// that of cjpeg. Throws `error` if a side is zero or above 65500. Threads may call it.
/// Precondition: `rgb` has 3 * width * height bytes.
std::vector<std::uint8_t> encode_jpeg(int width, int height, const std::vector<std::uint8_t>& rgb,
                                      int quality);

/// Averages over areas. Each output pixel is the mean of the input pixels that it covers, including
/// fractions of pixels. Masked pixels do not count. An output pixel is masked if masked pixels
/// cover more than half of it. Precondition: 1 <= width <= source.width, and likewise for the
/// height.
image downsample(const image& source, int width, int height);

/// Returns the image over a constant background, as three planes of values in [0, 1]. Masked pixels
/// show the background.
std::vector<float> over_background(const image& source, const float background[3]);

}  // namespace gs
