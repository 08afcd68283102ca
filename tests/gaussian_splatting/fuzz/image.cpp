// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image/image.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "harness.hpp"

namespace gs_fuzz {
namespace {

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

/// A changed chunk would mostly fall at its checksum, and never be looked into.
std::string with_checksums(std::string png) {
    constexpr std::size_t signature = 8, head = 8, checksum = 4;
    for (std::size_t at = signature; at + head + checksum <= png.size();) {
        const std::size_t length = big_endian(png, at);
        if (length > png.size() - at - head - checksum) break;
        const auto* const type_and_data = reinterpret_cast<const Bytef*>(png.data() + at + 4);
        const auto crc = crc32(0, type_and_data, static_cast<uInt>(4 + length));
        at += head + length;
        for (int shift = 24; shift >= 0; shift -= 8) png[at++] = static_cast<char>(crc >> shift & 0xFF);
    }
    return png;
}

bool is_png(std::string_view bytes) { return bytes.starts_with("\x89PNG\r\n\x1A\n"); }

std::size_t padded(int side) { return (static_cast<std::size_t>(side) + 31) / 32 * 32; }

/// What an image takes to decode: RGBA, and a progressive JPEG's coefficients, two bytes in each of three
/// planes of whole blocks; some rows, of up to 8 bytes a sample; inflate's window.
std::size_t decoding(int width, int height) {
    const std::size_t pixels = padded(width) * padded(height);
    return (4 + 3 * 2) * pixels + 512 * padded(width) + 8 * padded(height) + (64 << 10);
}

}  // namespace

bool image(std::string_view input) {
    constexpr int most_pixels = 1 << 16;
    const std::string bytes = is_png(input) ? with_checksums(std::string(input)) : std::string(input);
    int width = 0, height = 0;
    const auto read_size = [&](const std::filesystem::path& file) {
        gs::read_image_size(file, width, height);
    };
    if (!load_within_budget(bytes, read_size)) return false;
    if (width > most_pixels / height) return false;
    return load_within_budget(
        bytes, [](const std::filesystem::path& file) { gs::read_image(file); },
        [&] { return decoding(width, height); });
}

}  // namespace gs_fuzz
