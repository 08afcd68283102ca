// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <libheif/heif.h>
#include <webp/encode.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace gs_test {

/// Returns a number as bytes, from the lowest on.
inline std::string little_endian(std::uint32_t value, std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
    return bytes;
}

inline std::string big_endian(std::uint32_t value, std::size_t count) {
    std::string bytes = little_endian(value, count);
    std::ranges::reverse(bytes);
    return bytes;
}

// EXIF data

/// Returns EXIF data that hold nothing but the tag Orientation.
inline std::string exif(unsigned orientation, bool little = true) {
    const auto number = [&](std::uint32_t value, std::size_t count) {
        return little ? little_endian(value, count) : big_endian(value, count);
    };
    return std::string(little ? "II" : "MM") + number(42, 2) + number(8, 4) + number(1, 2) +
           number(0x0112, 2) + number(3, 2) + number(1, 4) + number(orientation, 2) + number(0, 2) +
           number(0, 4);
}

inline std::string jpeg_with_exif(const std::string& jpeg, const std::string& data) {
    using namespace std::string_literals;
    const std::string content = "Exif\0\0"s + data;
    return jpeg.substr(0, 2) + "\xFF\xE1" + big_endian(static_cast<std::uint32_t>(content.size() + 2), 2) +
           content + jpeg.substr(2);
}

inline std::uint32_t crc_of(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

inline std::string png_with_exif(const std::string& png, const std::string& data) {
    constexpr std::size_t end_of_header = 33;
    const std::string content = "eXIf" + data;
    return png.substr(0, end_of_header) + big_endian(static_cast<std::uint32_t>(data.size()), 4) + content +
           big_endian(crc_of(content), 4) + png.substr(end_of_header);
}

inline std::string riff_chunk(const std::string& name, const std::string& content) {
    return name + little_endian(static_cast<std::uint32_t>(content.size()), 4) + content +
           std::string(content.size() % 2, '\0');
}

/// Precondition: the WebP has no alpha channel and one chunk.
inline std::string webp_with_exif(const std::string& webp, int width, int height, const std::string& data) {
    constexpr std::uint32_t has_exif = 8;
    const std::string header = little_endian(has_exif, 4) +
                               little_endian(static_cast<std::uint32_t>(width - 1), 3) +
                               little_endian(static_cast<std::uint32_t>(height - 1), 3);
    return riff_chunk("RIFF",
                      "WEBP" + riff_chunk("VP8X", header) + webp.substr(12) + riff_chunk("EXIF", data));
}

// WebP

/// Encodes RGBA pixels. A quality of 100 is lossless.
inline std::string webp_of(int width, int height, const std::vector<std::uint8_t>& rgba, float quality) {
    std::uint8_t* bytes = nullptr;
    const std::size_t count = quality < 100
                                  ? WebPEncodeRGBA(rgba.data(), width, height, 4 * width, quality, &bytes)
                                  : WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &bytes);
    if (count == 0) throw std::runtime_error("cannot encode a WebP");
    const std::string result(reinterpret_cast<const char*>(bytes), count);
    WebPFree(bytes);
    return result;
}

// HEIC and AVIF

struct heif_kind {
    heif_compression_format coding = heif_compression_HEVC;
    heif_orientation turn = heif_orientation_normal;  ///< stored as transformations, not as EXIF data
    std::string exif_data = {};                       ///< added if it is not empty
    bool alpha = false;
    bool premultiplied = false;
};

inline void require(const heif_error& result) {
    if (result.code != heif_error_Ok) throw std::runtime_error(result.message);
}

inline std::string bytes_of(heif_context* context) {
    std::string bytes;
    heif_writer writer{1, [](heif_context*, const void* data, std::size_t size, void* to) {
                           static_cast<std::string*>(to)->append(static_cast<const char*>(data), size);
                           return heif_error{heif_error_Ok, heif_suberror_Unspecified, ""};
                       }};
    require(heif_context_write(context, &writer, &bytes));
    return bytes;
}

/// Encodes RGBA pixels in the highest lossy quality.
inline std::string heif_of(int width, int height, const std::vector<std::uint8_t>& rgba,
                           const heif_kind& kind = {}) {
    const std::unique_ptr<heif_context, decltype(&heif_context_free)> context(heif_context_alloc(),
                                                                              heif_context_free);
    heif_image* pixels = nullptr;
    const int channels = kind.alpha ? 4 : 3;
    require(heif_image_create(width, height, heif_colorspace_RGB,
                              kind.alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB,
                              &pixels));
    const std::unique_ptr<heif_image, decltype(&heif_image_release)> owner(pixels, heif_image_release);
    require(heif_image_add_plane(pixels, heif_channel_interleaved, width, height, 8));
    heif_image_set_premultiplied_alpha(pixels, kind.premultiplied);
    int stride = 0;
    std::uint8_t* rows = heif_image_get_plane(pixels, heif_channel_interleaved, &stride);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            std::copy_n(&rgba[4 * static_cast<std::size_t>(y * width + x)], channels,
                        rows + y * stride + channels * x);
    heif_encoder* encoder = nullptr;
    require(heif_context_get_encoder_for_format(context.get(), kind.coding, &encoder));
    const std::unique_ptr<heif_encoder, decltype(&heif_encoder_release)> held(encoder, heif_encoder_release);
    require(heif_encoder_set_lossy_quality(encoder, 100));
    require(heif_encoder_set_parameter(encoder, "chroma", "444"));
    heif_encoding_options* options = heif_encoding_options_alloc();
    const std::unique_ptr<heif_encoding_options, decltype(&heif_encoding_options_free)> freed(
        options, heif_encoding_options_free);
    options->image_orientation = kind.turn;
    heif_image_handle* photo = nullptr;
    require(heif_context_encode_image(context.get(), pixels, encoder, options, &photo));
    const std::unique_ptr<heif_image_handle, decltype(&heif_image_handle_release)> released(
        photo, heif_image_handle_release);
    if (!kind.exif_data.empty())
        require(heif_context_add_exif_metadata(context.get(), photo, kind.exif_data.data(),
                                               static_cast<int>(kind.exif_data.size())));
    return bytes_of(context.get());
}

}  // namespace gs_test
