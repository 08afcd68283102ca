// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "mask.hpp"

#include <cmath>

#include "../error.hpp"

namespace gs {

std::filesystem::path mask_of(const std::filesystem::path& folder, const std::string& photo) {
    for (const auto& file : {folder / (photo + ".png"), (folder / photo).replace_extension(".png")})
        if (std::filesystem::is_regular_file(file)) return file;
    return {};
}

image read_mask(const std::filesystem::path& file, const image& photo) {
    const image mask = read_image(file);
    const double x = static_cast<double>(mask.width) / photo.width;
    const double y = static_cast<double>(mask.height) / photo.height;
    if (mask.width < photo.width || mask.height < photo.height || std::abs(x / y - 1) > 0.01)
        throw error("the mask " + file.string() + " is of the wrong size: it has " +
                    std::to_string(mask.width) + "x" + std::to_string(mask.height) + " pixels, its photo " +
                    std::to_string(photo.width) + "x" + std::to_string(photo.height));
    return shrink(mask, photo.width, photo.height);
}

void apply_mask(const image& mask, image& photo) {
    for (std::size_t i = 0; i < mask.rgba.size() / 4; ++i)
        if (mask.rgba[4 * i] < 128) photo.leave_out(i);
    photo.has_alpha = photo.has_transparent_pixel();
}

}  // namespace gs
