// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "mask.hpp"

#include <algorithm>
#include <cmath>

#include "../core/error.hpp"

namespace gs {

std::filesystem::path beside_photo(const std::filesystem::path& folder, const std::string& photo) {
    const auto name = std::filesystem::path(photo).lexically_normal();
    if (name.empty() || name.is_absolute() || *name.begin() == "..") return {};
    for (const auto& file : {folder / (name.string() + ".png"), (folder / name).replace_extension(".png")})
        if (std::filesystem::is_regular_file(file)) return file;
    return {};
}

image read_mask(const std::filesystem::path& file, const image& photo) {
    image mask = read_image(file);
    const double x = static_cast<double>(mask.width) / photo.width;
    const double y = static_cast<double>(mask.height) / photo.height;
    if (mask.width < photo.width || mask.height < photo.height || std::abs(x / y - 1) > 0.01)
        throw error("the mask " + file.string() + " is of the wrong size: it has " +
                    std::to_string(mask.width) + "x" + std::to_string(mask.height) + " pixels, its photo " +
                    std::to_string(photo.width) + "x" + std::to_string(photo.height));
    for (std::size_t i = 0; i < mask.rgba.size(); i += 4) {
        const bool counts = mask.rgba[i] != 0 || mask.rgba[i + 1] != 0 || mask.rgba[i + 2] != 0;
        std::fill_n(&mask.rgba[i], 3, counts ? std::uint8_t{255} : std::uint8_t{0});
        mask.rgba[i + 3] = 255;
    }
    return downsample(mask, photo.width, photo.height);
}

void apply_mask(const image& mask, image& photo) {
    for (std::size_t i = 0; i < mask.rgba.size() / 4; ++i)
        if (mask.rgba[4 * i] < 128) photo.mask_pixel(i);
    photo.has_alpha = photo.has_transparent_pixel();
}

void mask_border(int width, image& photo) {
    if (width <= 0) return;
    std::size_t pixel = 0;
    for (int y = 0; y < photo.height; ++y)
        for (int x = 0; x < photo.width; ++x, ++pixel)
            if (std::min({x, y, photo.width - 1 - x, photo.height - 1 - y}) < width) photo.mask_pixel(pixel);
    photo.has_alpha = photo.has_transparent_pixel();
}

void clear_masked_depths(const image& photo, depth_map& depths) {
    for (std::size_t i = 0; i < depths.values.size(); ++i)
        if (photo.is_masked(i)) depths.values[i] = 0;
}

}  // namespace gs
