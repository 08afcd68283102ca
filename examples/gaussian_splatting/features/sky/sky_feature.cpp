// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_feature.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../text.hpp"
#include "sky_distance.hpp"
#include "sky_fit.hpp"

namespace gs::features {
namespace {

constexpr const char* has_alpha = "photos have transparent parts";
constexpr double least_share = 0.02;       ///< smallest share of the photos' area
constexpr double least_of_empty = 0.5;     ///< smallest share of the smooth area without points
constexpr double least_brightness = 0.08;  ///< a darker sky is treated as black

struct measured_sky {
    std::vector<photo_cells> cells;
    sky_fit fit;
    sky_distance distance;
};

/// Measures the distance in photos without the falloff that the sky itself shows. Points may not show it, and
/// it differs between two places of a photo.
sky_distance distance_of(const scene& photos, std::vector<photo_cells> cells, const sky_fit& fit,
                         const std::vector<double>& brightness) {
    const double strength = strength_of_falloff(photos, cells, fit, brightness);
    remove_falloff(photos, {strength, strength, strength}, cells);
    return measure_distance(photos, cells, fit, brightness);
}

/// Fits the sky to the photos as they are, except for a clear falloff, and, if their brightness is known, to
/// photos of equalized brightness. Returns the fit with the larger share, because an overexposed sky is white
/// in every photo.
measured_sky measure_sky(const scene_statistics& statistics) {
    const scene& photos = statistics.scene();
    if (photos.points.empty()) return {};
    std::vector<photo_cells> cells = divide_photos(photos);
    if (statistics.falloff().is_clear()) remove_falloff(photos, statistics.falloff().channels, cells);
    const std::vector<double>& brightness = statistics.brightness().log2;
    sky_fit found = fit_sky(photos, cells, {}), evened;
    if (!brightness.empty()) evened = fit_sky(photos, cells, brightness);
    const bool even = evened.share > found.share;
    if (even) found = std::move(evened);
    return {cells, found, distance_of(photos, cells, found, even ? brightness : std::vector<double>{})};
}

/// Returns for each square of a photo whether it counts as sky, or nothing for squares that may not.
std::vector<std::optional<bool>> is_sky(const photo_cells& photo,
                                        const std::vector<std::uint32_t>& predicted) {
    std::vector<std::optional<bool>> found(photo.cells.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        if (photo.cells[i].shows == photo_cell::content::smooth && !photo.cells[i].near_points)
            found[i] = false;
    for (const std::uint32_t i : predicted) found[i] = true;
    return found;
}

/// Returns the area of squares as a percentage of the photo.
double percentage(const photo_cells& photo, const std::vector<std::optional<bool>>& squares, bool sky,
                  const camera& taken_with) {
    const auto count = static_cast<double>(std::ranges::count(squares, std::optional(sky)));
    return 100 * count * photo.side * photo.side / (double(taken_with.width) * taken_with.height);
}

/// Returns the squares as rectangles, of which neighbors in a row are one.
std::vector<pages::mark> marks_of(const photo_cells& photo, const std::vector<std::optional<bool>>& squares) {
    std::vector<pages::mark> marks;
    const double side = photo.side;
    for (int row = 0; row < photo.down; ++row)
        for (int column = 0; column < photo.across; ++column) {
            const auto square = squares[static_cast<std::size_t>(row * photo.across + column)];
            if (!square) continue;
            const pages::mark made{.left = column * side,
                                   .top = row * side,
                                   .width = side,
                                   .height = side,
                                   .color = *square ? 0 : 1};
            const bool continues = !marks.empty() && marks.back().top == made.top &&
                                   marks.back().left + marks.back().width == made.left &&
                                   marks.back().color == made.color;
            if (continues)
                marks.back().width += side;
            else
                marks.push_back(made);
        }
    return marks;
}

}  // namespace

finding sky_feature::analyze(const scene_statistics& statistics) const {
    auto [cells, s, distance] = measure_sky(statistics);
    s.coefficients.resize(sky_width);
    if (!s.has_points) return {{}, "cannot decide: the scene has no points", "off", s.coefficients};
    if (statistics.scene().has_alpha) return {false, has_alpha, "off"};
    const bool exists = s.share >= least_share && s.share >= least_of_empty * s.empty &&
                        s.brightness >= least_brightness && !distance.is_near();
    std::string evidence = text(
        "%.1f %% of the pixels are smooth and without points; the direction alone predicts %.0f %% "
        "of them, with a brightness of %.0f %%",
        100 * s.empty, s.empty > 0 ? 100 * s.share / s.empty : 0.0, 100 * s.brightness);
    if (distance.is_near())
        evidence += text(
            "; these are near: %.0f %% of comparisons between photos match only at a distance "
            "of %g camera extents, %.0f %% only at infinity",
            100 * distance.near_only, distance.distance, 100 * distance.far_only);
    return {exists, std::move(evidence), exists ? "on" : "off", std::move(s.coefficients)};
}

explanation sky_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition = text("the direction predicts at least %.0f %% of all pixels and %.0f %% of the smooth "
                          "ones without points, with a brightness of at least %.0f %%; ",
                          100 * least_share, 100 * least_of_empty, 100 * least_brightness) +
                     text("the comparisons between photos that match only at a finite distance exceed "
                          "those that match only at infinity by at most %.0f %%",
                          100 * sky_distance::largest_excess)};
    const std::vector<view>& views = statistics.scene().train;
    const measured_sky measured = measure_sky(statistics);
    if (measured.fit.predicted.empty()) return made;
    std::vector<std::vector<std::optional<bool>>> squares;
    std::vector<double> sky, other;
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < views.size(); ++v) {
        squares.push_back(is_sky(measured.cells[v], measured.fit.predicted[v]));
        sky.push_back(percentage(measured.cells[v], squares[v], true, views[v].camera));
        other.push_back(percentage(measured.cells[v], squares[v], false, views[v].camera));
        order.push_back(v);
    }
    made.charts.push_back({"Smooth areas without points (% of the photo)",
                           "photo",
                           {curve_of_photos("predicted", sky), curve_of_photos("not predicted", other)},
                           true});
    const auto add = [&](std::size_t v, const char* label) {
        made.photos.push_back(shown_photo(views[v], label,
                                          "Smooth and without points. Blue: the direction predicts the "
                                          "color, as of a sky. Orange: it does not.",
                                          marks_of(measured.cells[v], squares[v])));
    };
    std::ranges::sort(order, std::greater(), [&](std::size_t v) { return sky[v]; });
    add(order.front(), "Most sky");
    if (order.size() > 2) add(order[order.size() / 2], "Typical photo");
    if (order.size() > 1) add(order.back(), "Least sky");
    return made;
}

std::vector<float> sky_feature::neutral_values(const scene&) const {
    return std::vector<float>(sky_width, 0.0f);
}

std::string sky_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    return scene.has_alpha ? has_alpha : "";
}

void sky_feature::prepare(const selected_feature& selected, scene&, gaussians& model) const {
    model.sky = selected.on ? selected.values : std::vector<float>{};
}

}  // namespace gs::features
