// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "depth_feature.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../../pages/picture.hpp"
#include "../../scene/view_photo.hpp"
#include "../text.hpp"
#include "depth_agreement.hpp"

namespace gs::features {
namespace {

constexpr double least_share = 0.5;  ///< smallest share of the depth maps that agree

std::vector<float> values_of(const depth_agreement& found) {
    std::vector<float> values;
    for (const depth_fit& fit : found.fits) values.insert(values.end(), {fit.scale, fit.offset});
    return values;
}

bool is_used(const std::vector<float>& values, std::size_t photo) { return values[2 * photo] > 0; }

/// Returns a depth map as an image: white is near, black is far, transparent is unknown.
image image_of(const depth_map& depths) {
    std::vector<std::uint16_t> known;
    for (const std::uint16_t value : depths.values)
        if (value != 0) known.push_back(value);
    image made{depths.width, depths.height, std::vector<std::uint8_t>(4 * depths.values.size(), 0)};
    if (known.empty()) return made;
    // Leaves out outliers, which would make all other values equal.
    std::ranges::sort(known);
    const double low = known[known.size() / 50], high = known[known.size() - 1 - known.size() / 50];
    for (std::size_t i = 0; i < depths.values.size(); ++i) {
        if (depths.values[i] == 0) continue;
        const double level = high > low ? (depths.values[i] - low) / (high - low) : 0.5;
        std::fill_n(&made.rgba[4 * i], 3, to_byte(static_cast<float>(level)));
        made.rgba[4 * i + 3] = 255;
    }
    return made;
}

}  // namespace

finding depth_feature::analyze(const scene_statistics& statistics) const {
    const depth_agreement found = compare_depths(statistics.scene());
    const bool agree = found.agreeing > 0 && static_cast<double>(found.agreeing) >=
                                                 least_share * static_cast<double>(found.with_map);
    std::optional<bool> recommended = agree;
    if (found.with_map > 0 && found.told == 0) recommended.reset();
    return {recommended, say(found), agree ? "on" : "off", values_of(found)};
}

explanation depth_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition =
            text("at least %.0f %% of the depth maps have a correlation of %.1f or more with the points",
                 100 * least_share, depth_agreement::least_correlation)};
    const std::vector<view>& views = statistics.scene().train;
    const depth_agreement found = compare_depths(statistics.scene());
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < views.size(); ++v)
        if (!std::isnan(found.correlations[v])) order.push_back(v);
    if (order.empty()) return made;
    made.charts.push_back({"Correlation of depth maps with the points",
                           "photo",
                           {curve_of_photos("depth map", found.correlations),
                            level_line("a map agrees above", static_cast<double>(views.size()),
                                       depth_agreement::least_correlation)},
                           true});
    std::ranges::sort(order, {}, [&](std::size_t v) { return found.correlations[v]; });
    const auto add = [&](std::size_t v, const char* label) {
        made.photos.push_back(shown_photo(views[v], label, text("Correlation %.2f.", found.correlations[v])));
        pages::marked_photo map = made.photos.back();
        map.note = "Its depth map: white is near, black is far, a checkerboard is unknown.";
        map.pixels = pages::thumbnail(image_of(view_photo(views[v]).depths()));
        made.photos.push_back(std::move(map));
    };
    add(order.front(), "Map that agrees least");
    if (order.size() > 1) add(order.back(), "Map that agrees most");
    return made;
}

std::vector<float> depth_feature::neutral_values(const scene& scene) const {
    return values_of(compare_depths(scene));
}

std::string depth_feature::obstacle(const scene& scene, const std::vector<float>& values) const {
    for (std::size_t photo = 0; photo < values.size() / 2; ++photo)
        if (is_used(values, photo)) return {};
    return say(compare_depths(scene));
}

void depth_feature::prepare(const selected_feature& selected, scene& scene, gaussians&) const {
    for (std::size_t photo = 0; photo < scene.train.size(); ++photo)
        if (!selected.on || !is_used(selected.values, photo)) scene.train[photo].depths = {};
    for (view& v : scene.test) v.depths = {};
}

}  // namespace gs::features
