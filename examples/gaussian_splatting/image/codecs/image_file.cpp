// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image_file.hpp"

#include <png.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include "../../core/error.hpp"

namespace gs {
namespace {

constexpr std::uint64_t largest_decoded_bytes = std::uint64_t{1} << 31;

// The densest format that is read is a 1-bit PNG with the best ratio of deflate, 1032 to 1.
constexpr std::uint64_t most_pixels_per_byte = 8 * 1032;

std::uint64_t big_endian(std::span<const std::uint8_t, 4> bytes) {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : bytes) value = value << 8 | byte;
    return value;
}

}  // namespace

void refuse(const std::filesystem::path& file, const std::string& why) {
    throw error("cannot read the image " + file.string() + ": " + why);
}

open_file open_to_read(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) refuse(file, "there is no such file");
    if (!std::filesystem::is_regular_file(file, ignored)) refuse(file, "it is not a file");
    open_file opened(std::fopen(file.c_str(), "rb"));
    if (!opened) refuse(file, std::strerror(errno));
    return opened;
}

void check_size(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width == 0 || height == 0) refuse(file, "it has no pixels (" + size + ")");
    if (width > largest_side || height > largest_side || 4 * width * height > largest_decoded_bytes)
        refuse(file, "its size, " + size + ", is too large");
}

void check_density(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height) {
    std::error_code ignored;
    if (width * height / most_pixels_per_byte > std::filesystem::file_size(file, ignored))
        refuse(file, "it is truncated");
}

image blank_image(int width, int height) {
    image blank;
    blank.width = width;
    blank.height = height;
    blank.rgba.resize(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return blank;
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

first_bytes look_at(const std::filesystem::path& file, std::FILE* opened) {
    constexpr std::size_t png_signature = 8;
    std::array<std::uint8_t, 24> start{};
    const std::size_t count = std::fread(start.data(), 1, start.size(), opened);
    std::rewind(opened);
    if (count == 0) refuse(file, "it is empty");
    first_bytes found;
    found.is_png = count >= png_signature && png_sig_cmp(start.data(), 0, png_signature) == 0;
    if (found.is_png) {
        if (count < start.size()) refuse(file, "it is truncated");
        const std::span<const std::uint8_t, 24> all(start);
        found.png_width = big_endian(all.subspan<16, 4>());
        found.png_height = big_endian(all.subspan<20, 4>());
        check_size(file, found.png_width, found.png_height);
    } else if (start[0] != 0xFF || start[1] != 0xD8) {
        refuse(file, "it is neither a PNG nor a JPEG");
    }
    return found;
}

}  // namespace gs
