// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <span>
#include <string_view>

#include "codec.hpp"
#include "jpeg_reader.hpp"

namespace gs {
namespace {

bool is_jpeg(std::span<const std::uint8_t> start) {
    return start.size() >= 2 && start[0] == 0xFF && start[1] == 0xD8;
}

image_size read_jpeg_size(const image_file& file) {
    jpeg_reader reader;
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    return reader.size();
}

orientation read_jpeg_orientation(const image_file& file) {
    jpeg_reader reader;
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    return orientation_in_exif(reader.exif());
}

/// Each ink removes its share of the light, without the color profile of a printer.
void cmyk_to_rgba(image& pixels, bool inverted) {
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        std::uint8_t* const pixel = &pixels.rgba[i];
        const auto light = [&](std::size_t ink) { return inverted ? pixel[ink] : 255U - pixel[ink]; };
        const unsigned black = light(3);
        for (std::size_t ink = 0; ink < 3; ++ink)
            pixel[ink] = static_cast<std::uint8_t>((light(ink) * black + 127) / 255);
        pixel[3] = 255;
    }
}

void read_jpeg(const image_file& file, image& pixels) {
    jpeg_reader reader;
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    file.check_decoded_size(reader.size(), size_of(pixels));
    if (!reader.read_rows(pixels.rgba.data())) refuse_jpeg(file, reader);
    if (reader.is_cmyk()) cmyk_to_rgba(pixels, reader.has_inverted_cmyk());
}

constexpr std::string_view jpeg_endings[] = {".jpg", ".jpeg"};

}  // namespace

extern constinit const image_codec jpeg_codec{"JPEG",         jpeg_endings,          is_jpeg,
                                              read_jpeg_size, read_jpeg_orientation, read_jpeg};

}  // namespace gs
