// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image/image.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "harness.hpp"
#include "image/jpeg_planes.hpp"

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

bool is_heif(std::string_view bytes) { return bytes.size() > 8 && bytes.substr(4, 4) == "ftyp"; }

std::size_t padded(int side) { return (static_cast<std::size_t>(side) + 31) / 32 * 32; }

/// Metadata become objects, one for each EXIF tag of 12 bytes or HEIF box of 8 bytes. A JPEG's marker that
/// is cut off may claim 64 KB.
std::size_t parsing(std::size_t file_bytes) { return 32 * file_bytes + (64 << 10); }

/// The memory that decoding takes: RGBA; the coefficients of a progressive JPEG, two bytes in each of up to
/// four planes of whole blocks; some rows, of up to 8 bytes a sample; inflate's window.
std::size_t decoding(int width, int height) {
    const std::size_t pixels = padded(width) * padded(height);
    return (4 + 4 * 2) * pixels + 512 * padded(width) + 8 * padded(height) + (64 << 10);
}

/// A lossless WebP may have Huffman tables of 12 KB for each block of 16 pixels. The decoders of HEIF trust
/// the size of the coded image, which only libFuzzer's limit of memory bounds.
std::size_t decoding(std::string_view bytes, int width, int height) {
    constexpr std::size_t huffman_tables = 750, of_heif = std::size_t{1} << 30;
    if (is_heif(bytes)) return of_heif;
    const std::size_t tables =
        bytes.starts_with("RIFF") ? huffman_tables * padded(width) * padded(height) : 0;
    return decoding(width, height) + tables;
}

/// Two ways to read a JPEG give the same pixels.
void read_both_ways(const std::filesystem::path& file) {
    const gs::image expected = gs::read_image(file);
    if (gs::jpeg_plane_bytes(file) == 0) return;
    gs::jpeg_planes planes;
    try {
        gs::read_jpeg_planes(file, planes);
    } catch (const gs::error&) {
        throw std::logic_error("read_jpeg_planes refuses a file that read_image accepts");
    }
    std::vector<std::uint8_t> rgba(expected.rgba.size());
    gs::to_rgba(planes, rgba.data());
    if (rgba != expected.rgba) throw std::logic_error("read_jpeg_planes gives other pixels than read_image");
}

}  // namespace

bool image(std::string_view input) {
    constexpr int most_pixels = 1 << 16;
    const std::string bytes = is_png(input) ? with_checksums(std::string(input)) : std::string(input);
    int width = 0, height = 0;
    const auto read_size = [&](const std::filesystem::path& file) {
        gs::read_image_size(file, width, height);
    };
    if (!load_within_budget(bytes, read_size, [&] { return parsing(bytes.size()); })) return false;
    if (width > most_pixels / height) return false;
    return load_within_budget(bytes, read_both_ways, [&] {
        const std::size_t second_copy = 6 * padded(width) * padded(height);
        return parsing(bytes.size()) + decoding(bytes, width, height) + second_copy;
    });
}

}  // namespace gs_fuzz
