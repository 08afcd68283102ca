// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "depth_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "../../core/parallel.hpp"
#include "../../scene/observations.hpp"
#include "../../scene/view_photo.hpp"

namespace gs::features {
namespace {

constexpr std::size_t least_points = 10;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// Returns the median of a member of the pairs, and the median distance from it.
std::pair<double, double> spread_of(const std::vector<depth_pair>& pairs, double depth_pair::*number) {
    std::vector<double> values;
    for (const depth_pair& p : pairs) values.push_back(p.*number);
    const double middle = median(values);
    for (double& x : values) x = std::abs(x - middle);
    return {middle, median(values)};
}

/// Fits the line of one photo. Returns nothing if it has no depth map, or if too few points have
/// values.
std::optional<depth_line> line_of(const view& photo, const std::vector<colored_point>& points) {
    if (!photo.depths.is_there()) return std::nullopt;
    const view_photo loaded(photo);
    const depth_map& depths = loaded.depths();
    std::vector<depth_pair> pairs;
    for (const place_in_photo& p : points_in_sight(photo.camera, points)) {
        const auto row = static_cast<std::size_t>(p.y), column = static_cast<std::size_t>(p.x);
        const auto value = depths.values[row * static_cast<std::size_t>(depths.width) + column];
        if (value != 0) pairs.push_back({static_cast<double>(value), 1 / p.depth});
    }
    if (pairs.size() < least_points) return std::nullopt;
    return fit_line(pairs);
}

}  // namespace

depth_line fit_line(const std::vector<depth_pair>& pairs) {
    constexpr int rounds = 10;
    constexpr double outlier = 3;  // standard deviations
    const auto [x0, x_apart] = spread_of(pairs, &depth_pair::inverse_depth);
    const auto [y0, y_apart] = spread_of(pairs, &depth_pair::value);
    if (!(x_apart > 0 && y_apart > 0)) return {};  // half of the pairs or more have equal values
    depth_line line{x_apart / y_apart, x0 - x_apart / y_apart * y0, 0};
    std::vector<double> off(pairs.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < pairs.size(); ++i)
            off[i] = std::abs((pairs[i].inverse_depth - line.offset) / line.scale - pairs[i].value);
        const double limit = outlier * 1.4826 * median(off);
        const auto kept = [&](const auto& f) {
            for (std::size_t i = 0; i < pairs.size(); ++i)
                if (off[i] <= limit) f(pairs[i].inverse_depth, pairs[i].value);
        };
        double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
        kept([&](double inverse_depth, double value) {
            ++count;
            x += inverse_depth;
            y += value;
        });
        kept([&](double inverse_depth, double value) {
            const double dx = inverse_depth - x / count, dy = value - y / count;
            xx += dx * dx;
            xy += dx * dy;
            yy += dy * dy;
        });
        if (!(xy > 0)) return {};
        line = {xx / xy, (x - xx / xy * y) / count, xy / std::sqrt(xx * yy)};
    }
    return line;
}

depth_agreement compare_depths(const scene& of) {
    depth_agreement found;
    found.photos = of.train.size();
    found.fits.resize(of.train.size());
    found.correlations.assign(of.train.size(), std::nan(""));
    std::vector<std::optional<depth_line>> lines(of.train.size());
    for_each_in_parallel(of.train.size(), [&](std::size_t v) { lines[v] = line_of(of.train[v], of.points); });
    std::vector<double> correlations;
    for (std::size_t v = 0; v < of.train.size(); ++v) {
        found.with_map += of.train[v].depths.is_there() ? 1 : 0;
        if (!lines[v]) continue;
        ++found.told;
        correlations.push_back(lines[v]->correlation);
        found.correlations[v] = lines[v]->correlation;
        if (lines[v]->correlation < depth_agreement::least_correlation) continue;
        ++found.agreeing;
        found.fits[v] = {static_cast<float>(lines[v]->scale), static_cast<float>(lines[v]->offset)};
    }
    if (!correlations.empty()) found.correlation = median(correlations);
    return found;
}

std::string say(const depth_agreement& found) {
    char line[200];
    if (found.with_map == 0) return "no training photo has a depth map";
    if (found.told == 0)
        std::snprintf(line, sizeof line,
                      "cannot decide: %zu of %zu photos have depth maps, but no map covers %zu points",
                      found.with_map, found.photos, least_points);
    else
        std::snprintf(line, sizeof line,
                      "%zu of %zu photos have depth maps, of which %zu agree with the points; the median "
                      "correlation is %.2f",
                      found.with_map, found.photos, found.agreeing, found.correlation);
    return line;
}

}  // namespace gs::features
