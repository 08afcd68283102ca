// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gs {

/// An image with red, green, blue and alpha as bytes.
struct rgba_image {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> pixels{};

    rgba_image() = default;
    rgba_image(std::size_t w, std::size_t h) : width(w), height(h), pixels(4 * w * h) {}
    std::uint8_t* pixel(std::size_t i) { return &pixels[4 * i]; }
    const std::uint8_t* pixel(std::size_t i) const { return &pixels[4 * i]; }
};

/// Returns a lossless WebP file, which also keeps the colors of transparent pixels. Sides are at most
/// 16383 pixels.
std::string webp_of(const rgba_image& image);

/// Returns the size of a WebP image without decoding it, or nothing if it is not a WebP image.
struct image_size {
    std::size_t width, height;
};
std::optional<image_size> webp_size(const std::string& webp);

/// Decodes a WebP image. Returns nothing if it is damaged.
std::optional<rgba_image> decoded_webp(const std::string& webp);

}  // namespace gs
