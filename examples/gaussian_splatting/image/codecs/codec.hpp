// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "exif.hpp"
#include "image_file.hpp"

namespace gs {

/// A format of image files. To add one, write its file in this folder and add it to the table in
/// codecs.cpp. All functions throw `error` for malformed files.
struct image_codec {
    std::string_view name;                      ///< for messages, such as "PNG"
    std::span<const std::string_view> endings;  ///< usual endings of files, such as ".png"

    /// Returns whether the first bytes of a file, up to `probed_bytes`, identify this format.
    bool (*probe)(std::span<const std::uint8_t> start);

    /// Reads the size from the header, without memory for pixels.
    image_size (*read_size)(const image_file& file);

    /// Reads the orientation from EXIF data; null if `read` returns upright images.
    orientation (*read_orientation)(const image_file& file);

    /// Sets all pixels of an opaque image that has the size of the file, which has been checked.
    /// See `read_image` for the memory that it may allocate.
    void (*read)(const image_file& file, image& pixels);
};

inline constexpr std::size_t probed_bytes = 32;

extern const image_codec heif_codec, jpeg_codec, png_codec, webp_codec;

/// Returns all codecs, in the order in which `codec_of` calls their `probe`.
std::span<const image_codec* const> all_image_codecs();

/// Returns the codec that the first bytes determine. Throws `error` if there is none.
const image_codec& codec_of(const image_file& file);

}  // namespace gs
