// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "moving_feature.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "../half_way/half_way_statistics.hpp"
#include "../text.hpp"
#include "moving_evidence.hpp"

namespace gs::features {

finding moving_feature::analyze(const scene_statistics& statistics) const {
    const moving_evidence found = find_moving_things(statistics);
    if (found.points < enough_points)
        return {{}, too_few_points(found.points, "comparable and of one color"), "off"};
    return {found.is_clear(),
            text("something hides groups of points in %zu of %zu photos, which show them from other places",
                 found.count(), found.photos.size()),
            found.is_clear() ? "on" : "off"};
}

finding moving_feature::review(const half_way_statistics& statistics) const {
    const moving_evidence found = find_moving_things(statistics.parts(), statistics.scene().train.size());
    if (found.points < enough_parts) return {{}, too_few_parts(found.points, "parts"), "off"};
    const std::size_t hidden = found.hidden_in_large_shares();
    const bool is_clear = hidden >= moving_evidence::least_hidden;
    return {is_clear,
            text("something hides %zu parts of the model, in photos where it hides at least %.0f %% of them",
                 hidden, 100 * moving_evidence::least_share),
            is_clear ? "on" : "off"};
}

explanation moving_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition =
            text("something hides at least %zu points and %.0f %% of the compared points in two photos",
                 moving_evidence::least_hidden, 100 * moving_evidence::least_share)};
    const moving_evidence found = find_moving_things(statistics);
    if (found.points == 0) return made;
    std::vector<double> shares;
    std::vector<std::size_t> order;
    for (const hidden_points& photo : found.photos) {
        order.push_back(shares.size());
        shares.push_back(100 * photo.share());
    }
    made.charts.push_back({"Points that something hides (% of the compared points)",
                           "photo",
                           {curve_of_photos("photo", shares),
                            level_line("share that calls for the effect", static_cast<double>(shares.size()),
                                       100 * moving_evidence::least_share)},
                           true});
    std::ranges::sort(order, std::greater(), [&](std::size_t v) { return found.photos[v].hidden.size(); });
    order.resize(std::min<std::size_t>(order.size(), 3));
    for (const std::size_t v : order) {
        const hidden_points& photo = found.photos[v];
        if (v != order.front() && photo.hidden.empty()) break;
        std::vector<pages::mark> marks;
        for (const observation& o : photo.hidden) marks.push_back(ring_around(o, 1));
        made.photos.push_back(shown_photo(
            statistics.scene().train[v], v == order.front() ? "Most hidden points" : "More hidden points",
            text("Rings: something hides %zu of %zu compared points.", photo.hidden.size(), photo.compared),
            std::move(marks)));
    }
    return made;
}

}  // namespace gs::features
