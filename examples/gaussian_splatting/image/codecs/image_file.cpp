// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "../../core/error.hpp"

namespace gs {
namespace {

constexpr std::uint64_t largest_decoded_bytes = std::uint64_t{1} << 31;

// The best ratio of a 1-bit PNG, whose deflate reaches 1032 to 1. WebP, HEIC and AVIF can store an
// image of one color in fewer bytes, but no photo.
constexpr std::uint64_t most_pixels_per_byte = 8 * 1032;

std::string text_of(const image_size& size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

image_file::image_file(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code ignored;
    if (!std::filesystem::exists(path_, ignored)) refuse("there is no such file");
    if (!std::filesystem::is_regular_file(path_, ignored)) refuse("it is not a file");
    stream_.reset(std::fopen(path_.c_str(), "rb"));
    if (!stream_) refuse(std::strerror(errno));
}

std::FILE* image_file::rewound() const {
    std::rewind(stream_.get());
    return stream_.get();
}

std::uint64_t image_file::size_in_bytes() const {
    std::error_code failed;
    const auto size = std::filesystem::file_size(path_, failed);
    if (failed) refuse(failed.message());
    return size;
}

std::vector<std::uint8_t> image_file::bytes(std::size_t most) const {
    std::vector<std::uint8_t> content(std::min(size_in_bytes(), most));
    if (std::fread(content.data(), 1, content.size(), rewound()) < content.size()) refuse("it is truncated");
    return content;
}

void image_file::refuse(const std::string& why) const {
    throw error("cannot read the image " + path_.string() + ": " + why);
}

void image_file::check_size(const image_size& size) const {
    const auto [width, height] = size;
    if (width == 0 || height == 0) refuse("it has no pixels (" + text_of(size) + ")");
    if (width > largest_side || height > largest_side || 4 * width * height > largest_decoded_bytes)
        refuse("its size, " + text_of(size) + ", is too large");
}

void image_file::check_density(const image_size& size) const {
    const std::uint64_t bytes = size_in_bytes();
    if (size.width * size.height / most_pixels_per_byte > bytes)
        refuse("it is truncated: " + std::to_string(bytes) + " bytes are too few for " + text_of(size) +
               " pixels");
}

void image_file::check_decoded_size(const image_size& found, const image_size& promised) const {
    if (found != promised)
        refuse("its header promises " + text_of(promised) + " pixels, but it has " + text_of(found));
}

image_size size_of(const image& pixels) {
    return {static_cast<std::uint64_t>(pixels.width), static_cast<std::uint64_t>(pixels.height)};
}

void premultiply(image& pixels) {
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        const unsigned alpha = pixels.rgba[i + 3];
        if (alpha == 255) continue;
        pixels.has_alpha = true;
        for (std::size_t channel = i; channel < i + 3; ++channel)
            pixels.rgba[channel] = static_cast<std::uint8_t>((pixels.rgba[channel] * alpha + 127) / 255);
    }
}

}  // namespace gs
