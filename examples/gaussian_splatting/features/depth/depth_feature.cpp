// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "depth_feature.hpp"

#include <algorithm>

#include "depth_agreement.hpp"

namespace gs::features {
namespace {

std::vector<float> values_of(const depth_agreement& found) {
    std::vector<float> values;
    for (const depth_fit& fit : found.fits) values.insert(values.end(), {fit.scale, fit.offset});
    return values;
}

bool is_used(const std::vector<float>& values, std::size_t photo) { return values[2 * photo] > 0; }

}  // namespace

finding depth_feature::analyze(const scene_statistics& statistics) const {
    constexpr double least_share = 0.5;  // share of the photos with depth maps
    const depth_agreement found = compare_depths(statistics.scene());
    const bool agree = found.agreeing > 0 && static_cast<double>(found.agreeing) >=
                                                 least_share * static_cast<double>(found.with_map);
    std::optional<bool> recommended = agree;
    if (found.with_map > 0 && found.told == 0) recommended.reset();
    return {recommended, say(found), agree ? "on" : "off", values_of(found)};
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
