// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "first_points.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "../core/error.hpp"
#include "../core/random.hpp"
#include "../stereo/dense_points.hpp"
#include "initialize.hpp"

namespace gs::train {
namespace {

/// With fewer points, stereo has failed: they can be wrong.
constexpr std::size_t least_points = 500;

/// Returns random points of at most half of the allowed number of Gaussians, so that densification can add
/// Gaussians where they matter.
std::vector<colored_point> drawn_at_random(const scene& of, std::size_t most, std::uint64_t seed) {
    constexpr std::size_t most_random = 100000;
    return random_points(of, std::min(most_random, most / 2 + 1), seed);
}

/// Returns a random sample of at most `most` points. All subsets are equally likely.
std::vector<colored_point> sampled(std::vector<colored_point> points, std::size_t most, std::uint64_t seed) {
    const std::size_t count = std::min(most, points.size());
    counter_random random(seed, 0, 0);
    for (std::size_t i = 0; i < count; ++i)
        std::swap(points[i], points[i + static_cast<std::size_t>(random.below(points.size() - i))]);
    points.resize(count);
    return points;
}

}  // namespace

first_points find_first_points(const scene& of, point_source source, std::size_t most, std::uint64_t seed) {
    if (source == point_source::random) return {drawn_at_random(of, most, seed), "begins with random points"};
    if (source == point_source::given && of.points.empty())
        throw error("the scene has no points, which --init given needs: use --init auto");
    const bool is_automatic = source == point_source::automatic;
    if (source == point_source::given || (is_automatic && of.points.size() >= enough_points))
        return {of.points, {}};
    if (is_automatic && of.rendered)
        return {of.points.empty() ? drawn_at_random(of, most, seed) : of.points, {}};

    const std::vector<colored_point> found = stereo::dense_points(of);
    const bool has_failed = found.size() < least_points;
    if (!is_automatic && has_failed)
        throw error("stereo finds only " + std::to_string(found.size()) +
                    " points in the photos, because they are too far apart, too smooth, or have wrong "
                    "poses: use --init auto");
    if (of.points.empty() && has_failed)
        return {drawn_at_random(of, most, seed),
                "begins with random points, because the scene has none and stereo finds hardly any"};
    first_points first{is_automatic ? of.points : std::vector<colored_point>(), {}};
    const std::vector<colored_point> added = sampled(found, enough_points - first.points.size(), seed);
    first.points.insert(first.points.end(), added.begin(), added.end());
    if (added.empty()) return first;
    first.remark = "begins with " + std::to_string(added.size()) + " points that stereo finds in the photos";
    if (is_automatic && !of.points.empty())
        first.remark += ", and " + std::to_string(of.points.size()) + " points of the scene";
    return first;
}

}  // namespace gs::train
