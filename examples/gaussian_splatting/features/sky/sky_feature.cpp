// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_feature.hpp"

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
