// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sog_images.hpp"

#include <webp/decode.h>
#include <webp/encode.h>

#include <memory>
#include <new>

namespace gs {
namespace {

constexpr int effort = 1;  ///< 0 to 9: higher levels take far longer and save little

const std::uint8_t* bytes_of(const std::string& webp) {
    return reinterpret_cast<const std::uint8_t*>(webp.data());
}

/// The memory of an image that libwebp encodes, and of the result.
struct encoder {
    WebPPicture picture;
    WebPMemoryWriter memory;

    encoder() {
        WebPPictureInit(&picture);
        WebPMemoryWriterInit(&memory);
    }
    encoder(const encoder&) = delete;
    encoder& operator=(const encoder&) = delete;
    ~encoder() {
        WebPPictureFree(&picture);
        WebPMemoryWriterClear(&memory);
    }
};

}  // namespace

std::string webp_of(const rgba_image& image) {
    WebPConfig config;
    WebPConfigInit(&config);
    WebPConfigLosslessPreset(&config, effort);
    config.exact = 1;
    encoder e;
    e.picture.use_argb = 1;
    e.picture.width = static_cast<int>(image.width);
    e.picture.height = static_cast<int>(image.height);
    e.picture.writer = WebPMemoryWrite;
    e.picture.custom_ptr = &e.memory;
    // Encoding fails only without memory, because sides and parameters are valid.
    if (WebPPictureImportRGBA(&e.picture, image.pixels.data(), static_cast<int>(4 * image.width)) == 0 ||
        WebPEncode(&config, &e.picture) == 0)
        throw std::bad_alloc();
    return {reinterpret_cast<const char*>(e.memory.mem), e.memory.size};
}

std::optional<image_size> webp_size(const std::string& webp) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes_of(webp), webp.size(), &features) != VP8_STATUS_OK || features.has_animation)
        return {};
    return image_size{static_cast<std::size_t>(features.width), static_cast<std::size_t>(features.height)};
}

std::optional<rgba_image> decoded_webp(const std::string& webp) {
    const auto size = webp_size(webp);
    if (!size) return {};
    rgba_image image(size->width, size->height);
    if (!WebPDecodeRGBAInto(bytes_of(webp), webp.size(), image.pixels.data(), image.pixels.size(),
                            static_cast<int>(4 * size->width)))
        return {};
    return image;
}

}  // namespace gs
