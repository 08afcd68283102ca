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

std::vector<std::size_t> masked_pixels_of(const std::vector<view>& views) {
    std::vector<std::size_t> masked(views.size(), 0);
    for_each_in_parallel(views.size(), [&](std::size_t v) {
        if (views[v].pixels.has_mask) masked[v] = masked_pixels_of(view_photo(views[v]).pixels());
    });
    return masked;
}

double pixels_of(const camera& c) { return double(c.width) * c.height; }

}  // namespace

finding masks_feature::analyze(const scene_statistics& statistics) const {
    const std::vector<view>& views = statistics.scene().train;
    const std::vector<std::size_t> masked = masked_pixels_of(views);
    std::size_t photos = 0;
    double masked_pixels = 0, all_pixels = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        photos += views[v].pixels.has_mask ? 1 : 0;
        all_pixels += pixels_of(views[v].camera);
        masked_pixels += static_cast<double>(masked[v]);
    }
    if (photos == 0) return {false, no_masks, "off"};
    return {true,
            text("%zu of %zu photos have masks, which exclude %.1f %% of all pixels", photos,
                 statistics.scene().train.size(), 100 * masked_pixels / all_pixels),
            "on"};
}

explanation masks_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{.condition = "a training photo has masked pixels"};
    const std::vector<view>& views = statistics.scene().train;
    const std::vector<std::size_t> masked = masked_pixels_of(views);
    std::vector<double> shares;
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < views.size(); ++v) {
        shares.push_back(100 * static_cast<double>(masked[v]) / pixels_of(views[v].camera));
        if (masked[v] > 0) order.push_back(v);
    }
    if (order.empty()) return made;
    made.charts.push_back({"Masked pixels (%)", "photo", {curve_of_photos("photo", shares)}, true});
    std::ranges::sort(order, {}, [&](std::size_t v) { return shares[v]; });
    const auto add = [&](std::size_t v, const char* label) {
        made.photos.push_back(
            shown_photo(views[v], label, text("Stripes: masked, %.1f %% of the pixels.", shares[v])));
    };
    add(order.back(), "Largest mask");
    if (order.size() > 1) add(order[order.size() / 2], "Typical mask");
    return made;
}

std::string masks_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    const bool some = std::ranges::any_of(scene.train, [](const view& v) { return v.pixels.has_mask; });
    return some ? "" : no_masks;
}

}  // namespace gs::features
