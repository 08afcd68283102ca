// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_feature.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "../text.hpp"
#include "sky_fit.hpp"

namespace gs::features {
namespace {

constexpr const char* has_alpha = "photos have transparent parts";
constexpr double least_share = 0.02;       ///< smallest share of the photos' area
constexpr double least_of_empty = 0.5;     ///< smallest share of the smooth area without points
constexpr double least_brightness = 0.08;  ///< a darker sky is treated as black

/// Fits the sky to the photos as they are and, if their brightness is known, to photos of equalized
/// brightness. Returns the fit with the larger share, because an overexposed sky is white in every
/// photo.
sky_fit best_fit(const scene_statistics& statistics) {
    sky_fit found = fit_sky(statistics.scene(), {});
    const std::vector<double>& brightness = statistics.brightness().log2;
    if (brightness.empty()) return found;
    sky_fit evened = fit_sky(statistics.scene(), brightness);
    return evened.share > found.share ? evened : found;
}

/// Returns the area of the cells of one photo, predicted or not, as a share of the photo.
double share_of(const std::vector<sky_cell>& cells, bool is_predicted, const camera& taken_with) {
    double area = 0;
    for (const sky_cell& c : cells)
        if (c.is_predicted == is_predicted) area += double(c.side) * c.side;
    return area / (double(taken_with.width) * taken_with.height);
}

/// Returns the cells as rectangles, of which neighbors in a row are one.
std::vector<pages::mark> marks_of(const std::vector<sky_cell>& cells) {
    std::vector<pages::mark> marks;
    for (const sky_cell& c : cells) {
        const pages::mark made{.left = double(c.left),
                               .top = double(c.top),
                               .width = double(c.side),
                               .height = double(c.side),
                               .color = c.is_predicted ? 0 : 1};
        const bool continues = !marks.empty() && marks.back().top == made.top &&
                               marks.back().left + marks.back().width == made.left &&
                               marks.back().color == made.color;
        if (continues)
            marks.back().width += made.width;
        else
            marks.push_back(made);
    }
    return marks;
}

}  // namespace

finding sky_feature::analyze(const scene_statistics& statistics) const {
    sky_fit s = best_fit(statistics);
    s.coefficients.resize(sky_width);
    if (!s.has_points) return {{}, "cannot decide: the scene has no points", "off", s.coefficients};
    if (statistics.scene().has_alpha) return {false, has_alpha, "off"};
    const bool exists =
        s.share >= least_share && s.share >= least_of_empty * s.empty && s.brightness >= least_brightness;
    return {exists,
            text("%.1f %% of the pixels are smooth and without points; the direction alone predicts %.0f %% "
                 "of them, with a brightness of %.0f %%",
                 100 * s.empty, s.empty > 0 ? 100 * s.share / s.empty : 0.0, 100 * s.brightness),
            exists ? "on" : "off", std::move(s.coefficients)};
}

explanation sky_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{.condition =
                         text("the direction predicts at least %.0f %% of all pixels and %.0f %% of "
                              "the smooth ones without points, with a brightness of at least %.0f %%",
                              100 * least_share, 100 * least_of_empty, 100 * least_brightness)};
    const std::vector<view>& views = statistics.scene().train;
    const sky_fit found = best_fit(statistics);
    if (found.cells.empty()) return made;
    std::vector<double> sky, other;
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < views.size(); ++v) {
        sky.push_back(100 * share_of(found.cells[v], true, views[v].camera));
        other.push_back(100 * share_of(found.cells[v], false, views[v].camera));
        order.push_back(v);
    }
    made.charts.push_back({"Smooth areas without points (% of the photo)",
                           "photo",
                           {curve_of_photos("found as sky", sky), curve_of_photos("not predicted", other)},
                           true});
    const auto add = [&](std::size_t v, const char* label) {
        made.photos.push_back(shown_photo(
            views[v], label,
            "Blue: found as sky. Orange: smooth and without points, but the direction does not predict it.",
            marks_of(found.cells[v])));
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
