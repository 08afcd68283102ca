// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "antialiasing_feature.hpp"

#include <algorithm>
#include <vector>

#include "../../core/median.hpp"
#include "../text.hpp"

namespace gs::features {
namespace {

constexpr double least_ratio = 2;

/// A point in the photos in which it is largest and smallest.
struct size_range {
    observation largest, smallest;

    double ratio() const { return static_cast<double>(smallest.footprint / largest.footprint); }
};

std::vector<size_range> size_ranges(const scene_statistics& statistics) {
    std::vector<size_range> ranges;
    for (const auto& seen : statistics.points()) {
        if (seen.size() < scene_statistics::least_photos_of_point) continue;
        const auto [least, most] = std::ranges::minmax(seen, {}, &observation::footprint);
        ranges.push_back({least, most});
    }
    return ranges;
}

}  // namespace

finding antialiasing_feature::analyze(const scene_statistics& statistics) const {
    std::vector<double> ratios;
    for (const size_range& range : size_ranges(statistics)) ratios.push_back(range.ratio());
    if (ratios.size() < enough_points) return {{}, too_few_points(ratios.size(), "visible"), "off"};
    const double ratio = median(ratios);
    const bool spreads = ratio >= least_ratio;
    return {spreads, text("the median point is %.1f times as large in one photo as in another", ratio),
            spreads ? "on" : "off"};
}

explanation antialiasing_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{.condition = text("the median point is at least %.1f times as large in one photo as in "
                                       "another",
                                       least_ratio)};
    std::vector<size_range> ranges = size_ranges(statistics);
    if (ranges.empty()) return made;
    std::ranges::sort(ranges, {}, &size_range::ratio);
    pages::curve points{"points", {{1, 100}}};
    // Leaves out the largest ratios, which may be outliers far away from all others.
    const std::size_t shown = (49 * ranges.size() + 49) / 50;
    for (std::size_t i = 0; i < shown; ++i)
        points.points.emplace_back(ranges[i].ratio(),
                                   100 - 100 * static_cast<double>(i) / static_cast<double>(ranges.size()));
    made.charts.push_back({"Points with this ratio of sizes or more (%)",
                           "largest size / smallest size of a point",
                           {std::move(points),
                            {text("factor %.1f; antialiasing needs half of the points", least_ratio),
                             {{least_ratio, 0}, {least_ratio, 50}}}},
                           true});
    const size_range& median = ranges[ranges.size() / 2];
    const scene& scene = statistics.scene();
    const std::string note =
        text("The ring marks a typical point; its sizes differ by the factor %.1f.", median.ratio());
    made.photos.push_back(
        shown_photo(scene.train[median.largest.view], "Near view", note, {ring_around(median.largest)}));
    made.photos.push_back(
        shown_photo(scene.train[median.smallest.view], "Far view", note, {ring_around(median.smallest)}));
    return made;
}

void antialiasing_feature::prepare(const selected_feature& selected, scene&, gaussians& model) const {
    model.antialiased = selected.on;
}

}  // namespace gs::features
