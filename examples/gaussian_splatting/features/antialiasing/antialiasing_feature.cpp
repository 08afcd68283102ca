// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "antialiasing_feature.hpp"

#include <algorithm>
#include <vector>

#include "../../core/median.hpp"
#include "../text.hpp"

namespace gs::features {

finding antialiasing_feature::analyze(const scene_statistics& statistics) const {
    constexpr double least_ratio = 2;
    std::vector<double> ratios;
    for (const auto& seen : statistics.points()) {
        if (seen.size() < scene_statistics::least_photos_of_point) continue;
        const auto [least, most] = std::ranges::minmax(seen, {}, &observation::footprint);
        ratios.push_back(most.footprint / least.footprint);
    }
    if (ratios.size() < enough_points) return {{}, too_few_points(ratios.size(), "visible"), "off"};
    const double ratio = median(ratios);
    const bool spreads = ratio >= least_ratio;
    return {spreads, text("the median point is %.1f times as large in one photo as in another", ratio),
            spreads ? "on" : "off"};
}

void antialiasing_feature::prepare(const selected_feature& selected, scene&, gaussians& model) const {
    model.antialiased = selected.on;
}

}  // namespace gs::features
