// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "moving_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "../../core/median.hpp"
#include "../../core/parallel.hpp"

namespace gs::features {
namespace {

constexpr float one_size = 2.2f;           ///< of footprints: see `keep_one_size`
constexpr double least_difference = 0.12;  ///< of a hidden point, in the channel that differs most
constexpr double typical = 0.75;           ///< quantile of the differences of a point
constexpr double times_typical = 3;        ///< difference of a hidden point relative to that quantile
constexpr double largest_typical = 0.09;   ///< of a point whose color is predicted
constexpr std::size_t similar_photos = 3;  ///< photos with similar directions that must look as usual
constexpr std::ptrdiff_t neighbors = 6;    ///< in the photo
constexpr std::ptrdiff_t hidden_neighbors = 5;
constexpr double most_differing = 0.6;  ///< share of the points in a photo

/// A point in a photo.
struct compared_point {
    observation seen;
    bool differs;
};

double largest_difference(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 d = glm::abs(a - b);
    return static_cast<double>(std::max({d.r, d.g, d.b}));
}

glm::vec3 median_color(const std::vector<observation>& seen) {
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) {
        std::vector<double> values;
        for (const observation& o : seen) values.push_back(static_cast<double>(o.color[c]));
        color[c] = static_cast<float>(median(values));
    }
    return color;
}

/// Returns whether a point looks as usual in the photos whose directions are most similar to that of
/// observation i.
bool is_usual_beside(const std::vector<observation>& seen, const std::vector<bool>& differs, std::size_t i) {
    std::vector<std::pair<float, bool>> others;
    for (std::size_t k = 0; k < seen.size(); ++k)
        if (k != i) others.emplace_back(-glm::dot(seen[k].direction, seen[i].direction), differs[k]);
    const auto end = others.begin() + static_cast<std::ptrdiff_t>(std::min(similar_photos, others.size()));
    std::partial_sort(others.begin(), end, others.end());
    return std::none_of(others.begin(), end, [](const auto& other) { return other.second; });
}

/// Removes points that too few photos show, and changes the colors to those of equal exposures.
void make_comparable(observed_points& points, std::size_t photos) {
    std::erase_if(points,
                  [](const auto& seen) { return seen.size() < scene_statistics::least_photos_of_point; });
    // Not `scene_statistics::brightness`: far photos can have too few smooth points, even if there are many.
    const photo_brightness brightness = estimate_brightness(points, photos);
    for (auto& seen : points)
        for (observation& o : seen) o.color *= static_cast<float>(std::exp2(-brightness.log2[o.view]));
}

/// Keeps the points that differ together with almost all points around them.
hidden_points hidden_in(const std::vector<compared_point>& points) {
    hidden_points found{points.size(), {}};
    const auto differing = std::ranges::count(points, true, &compared_point::differs);
    if (std::ssize(points) <= neighbors || double(differing) > most_differing * double(points.size()))
        return found;
    std::vector<std::pair<double, bool>> by_distance;
    for (const compared_point& p : points) {
        if (!p.differs) continue;
        by_distance.clear();
        for (const compared_point& other : points)
            by_distance.emplace_back(glm::distance(other.seen.place, p.seen.place), other.differs);
        const auto end = by_distance.begin() + neighbors + 1;  // the nearest one is the point itself
        std::nth_element(by_distance.begin(), end - 1, by_distance.end());
        const auto around =
            std::count_if(by_distance.begin(), end, [](const auto& near) { return near.second; }) - 1;
        if (around >= hidden_neighbors) found.hidden.push_back(p.seen);
    }
    return found;
}

}  // namespace

std::size_t moving_evidence::count() const {
    return static_cast<std::size_t>(std::ranges::count_if(photos, [](const hidden_points& photo) {
        return photo.hidden.size() >= least_hidden && photo.share() >= least_share;
    }));
}

std::vector<bool> moving_evidence::contributing_photos() const {
    constexpr std::size_t least_points = 2;
    std::vector<bool> contributes(photos.size(), false);
    if (!is_clear()) return contributes;
    for (std::size_t v = 0; v < photos.size(); ++v) contributes[v] = photos[v].hidden.size() >= least_points;
    return contributes;
}

std::size_t moving_evidence::hidden_in_large_shares() const {
    std::size_t sum = 0;
    for (const hidden_points& photo : photos)
        if (photo.share() >= least_share) sum += photo.hidden.size();
    return sum;
}

moving_evidence find_moving_things(const scene_statistics& statistics) {
    observed_points points = statistics.points();
    for (auto& seen : points) keep_one_size(seen, one_size);
    statistics.remove_clear_falloff(points);
    return find_moving_things(std::move(points), statistics.scene().train.size());
}

moving_evidence find_moving_things(observed_points points, std::size_t photos) {
    make_comparable(points, photos);
    moving_evidence found;
    found.photos.resize(photos);
    std::vector<std::vector<compared_point>> by_photo(photos);
    for (const std::vector<observation>& seen : points) {
        const glm::vec3 color = median_color(seen);
        std::vector<double> differences;
        for (const observation& o : seen) differences.push_back(largest_difference(o.color, color));
        const double usual = quantile(differences, typical);
        if (usual > largest_typical) continue;
        ++found.points;
        const double limit = std::max(least_difference, times_typical * usual);
        std::vector<bool> differs;
        for (const observation& o : seen) differs.push_back(largest_difference(o.color, color) > limit);
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const observation& o = seen[i];
            by_photo[o.view].push_back({o, differs[i] && is_usual_beside(seen, differs, i)});
        }
    }
    for_each_in_parallel(by_photo.size(), [&](std::size_t v) { found.photos[v] = hidden_in(by_photo[v]); });
    return found;
}

}  // namespace gs::features
