// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../core/large_memory.hpp"
#include "codecs/codec.hpp"

namespace gs {

namespace {

image_size checked_size(const image_file& file, const image_codec& codec) {
    const image_size size = codec.read_size(file);
    file.check_size(size);
    return size;
}

}  // namespace

image read_image(const std::filesystem::path& file) {
    image pixels;
    read_image(file, pixels);
    return pixels;
}

void read_image(const std::filesystem::path& path, image& pixels) {
    const image_file file(path);
    const image_codec& codec = codec_of(file);
    const image_size size = checked_size(file, codec);
    file.check_density(size);
    pixels = {static_cast<int>(size.width), static_cast<int>(size.height), std::move(pixels.rgba)};
    resize_for_image(pixels.rgba, 4 * size.width * size.height);
    codec.read(file, pixels);
}

image_header read_image_header(const std::filesystem::path& path) {
    const image_file file(path);
    const image_codec& codec = codec_of(file);
    const image_size size = checked_size(file, codec);
    image_header header{static_cast<int>(size.width), static_cast<int>(size.height), {}};
    if (codec.read_orientation) header.turn = codec.read_orientation(file);
    return header;
}

void read_image_size(const std::filesystem::path& file, int& width, int& height) {
    const image_header header = read_image_header(file);
    width = header.turn.swaps_sides ? header.height : header.width;
    height = header.turn.swaps_sides ? header.width : header.height;
}

void image::mask_pixel(std::size_t pixel) {
    const auto at = rgba.begin() + static_cast<std::ptrdiff_t>(4 * pixel);
    std::fill(at, at + 3, std::uint8_t{255});
    at[3] = 0;
    has_mask = true;
}

bool image::is_all_masked() const {
    std::size_t i = 0;
    while (i < rgba.size() / 4 && is_masked(i)) ++i;
    return i == rgba.size() / 4;
}

bool image::has_transparent_pixel() const {
    for (std::size_t i = 0; i < rgba.size() / 4; ++i)
        if (rgba[4 * i + 3] != 255 && !is_masked(i)) return true;
    return false;
}

std::uint8_t to_byte(float value) {
    if (!(value > 0)) return 0;  // includes NaN
    return static_cast<std::uint8_t>(std::lround(255.0F * std::min(value, 1.0F)));
}

std::vector<std::uint8_t> interleaved(const std::vector<float>& planes) {
    const std::size_t pixels = planes.size() / 3;
    std::vector<std::uint8_t> rgb(planes.size());
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = to_byte(planes[c * pixels + i]);
    return rgb;
}

std::vector<float> over_background(const image& source, const float background[3]) {
    const std::size_t plane = source.rgba.size() / 4;
    std::vector<float> planes(3 * plane);
    for (std::size_t i = 0; i < plane; ++i) {
        if (source.is_masked(i)) {
            for (std::size_t channel = 0; channel < 3; ++channel)
                planes[channel * plane + i] = background[channel];
            continue;
        }
        const float see_through = 1.0F - static_cast<float>(source.rgba[4 * i + 3]) / 255.0F;
        for (std::size_t channel = 0; channel < 3; ++channel)
            planes[channel * plane + i] =
                static_cast<float>(source.rgba[4 * i + channel]) / 255.0F + see_through * background[channel];
    }
    return planes;
}

}  // namespace gs
