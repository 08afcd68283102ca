// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image.hpp"

#include <algorithm>

#include "codecs/image_file.hpp"

namespace gs {

image read_image(const std::filesystem::path& file) {
    const open_file opened = open_to_read(file);
    const first_bytes found = look_at(file, opened.get());
    if (!found.is_png) return read_jpeg(file, opened.get());
    check_density(file, found.png_width, found.png_height);
    return read_png(file, opened.get(), static_cast<int>(found.png_width),
                    static_cast<int>(found.png_height));
}

void read_image_size(const std::filesystem::path& file, int& width, int& height) {
    const open_file opened = open_to_read(file);
    const first_bytes found = look_at(file, opened.get());
    if (found.is_png) {
        width = static_cast<int>(found.png_width);
        height = static_cast<int>(found.png_height);
        return;
    }
    read_jpeg_size(file, opened.get(), width, height);
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
