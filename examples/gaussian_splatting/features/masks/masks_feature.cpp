// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "masks_feature.hpp"

#include <algorithm>

#include "../text.hpp"

namespace gs::features {
namespace {

constexpr const char* no_masks = "no training photo has masked pixels";

}  // namespace

finding masks_feature::analyze(const scene_statistics& statistics) const {
    std::size_t photos = 0, masked_pixels = 0, all_pixels = 0;
    for (const view& v : statistics.scene().train) {
        photos += v.pixels.has_mask ? 1 : 0;
        const std::size_t pixels = v.pixels.rgba.size() / 4;
        all_pixels += pixels;
        for (std::size_t i = 0; v.pixels.has_mask && i < pixels; ++i)
            masked_pixels += v.pixels.is_masked(i) ? 1 : 0;
    }
    if (photos == 0) return {false, no_masks, "off"};
    return {true,
            text("%zu of %zu photos have masks, which exclude %.1f %% of all pixels", photos,
                 statistics.scene().train.size(),
                 100 * static_cast<double>(masked_pixels) / static_cast<double>(all_pixels)),
            "on"};
}

std::string masks_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    const bool some = std::ranges::any_of(scene.train, [](const view& v) { return v.pixels.has_mask; });
    return some ? "" : no_masks;
}

}  // namespace gs::features
