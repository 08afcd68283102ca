// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "masks_feature.hpp"

#include <algorithm>

#include "../../core/parallel.hpp"
#include "../../scene/view_photo.hpp"
#include "../text.hpp"

namespace gs::features {
namespace {

constexpr const char* no_masks = "no training photo has masked pixels";

std::size_t masked_pixels_of(const image& photo) {
    std::size_t masked = 0;
    for (std::size_t i = 0; i < photo.rgba.size() / 4; ++i) masked += photo.is_masked(i) ? 1 : 0;
    return masked;
}

}  // namespace

finding masks_feature::analyze(const scene_statistics& statistics) const {
    const std::vector<view>& views = statistics.scene().train;
    std::vector<std::size_t> masked(views.size(), 0);
    for_each_in_parallel(views.size(), [&](std::size_t v) {
        if (views[v].pixels.has_mask) masked[v] = masked_pixels_of(view_photo(views[v]).pixels());
    });
    std::size_t photos = 0, masked_pixels = 0, all_pixels = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        photos += views[v].pixels.has_mask ? 1 : 0;
        all_pixels += static_cast<std::size_t>(views[v].camera.width) *
                      static_cast<std::size_t>(views[v].camera.height);
        masked_pixels += masked[v];
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
