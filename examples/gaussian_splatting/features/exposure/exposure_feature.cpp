// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "exposure_feature.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../../core/median.hpp"
#include "../../core/write_json.hpp"
#include "../../training/training.hpp"
#include "../antialiasing/antialiasing_feature.hpp"
#include "../moving/moving_evidence.hpp"
#include "../text.hpp"
#include "held_out_exposures.hpp"

namespace gs::features {
namespace {

/// Smallest standard deviations of log2 of the brightness. In photos from very different distances, pixels
/// mix a point with different surroundings, so that its color differs without exposures.
constexpr double least_spread = 0.055, least_spread_of_distances = 0.1;
constexpr double least_errors = 3;  ///< smallest spread, in standard errors

double least_spread_in(const scene_statistics& statistics) {
    const bool distances_differ = antialiasing_feature().analyze(statistics).recommended.value_or(true);
    return distances_differ ? least_spread_of_distances : least_spread;
}

double root_mean_square(const std::vector<double>& values) {
    double sum = 0;
    for (const double x : values) sum += x * x;
    return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Returns the standard deviation of most photos: some may differ because things in them hide most points.
double typical_spread(std::vector<double> distances) {
    constexpr double deviations_per_median = 1.4826;  // of a normal distribution
    return distances.empty() ? 0 : deviations_per_median * median(distances);
}

double percent(double log2) { return 100 * (std::exp2(log2) - 1); }

std::vector<float> values_of(const photo_brightness& brightness, std::size_t photos) {
    std::vector<exposure> all(photos, identity_exposure);
    for (std::size_t v = 0; v < brightness.log2.size(); ++v)
        for (unsigned c = 0; c < 3; ++c)
            all[v][exposure_at(c, c)] = static_cast<float>(std::exp2(brightness.log2[v]));
    return flattened(all);
}

nlohmann::ordered_json to_json(const std::vector<view>& views, const std::vector<exposure>& exposures) {
    auto all = nlohmann::ordered_json::object();
    for (std::size_t v = 0; v < exposures.size(); ++v) {
        const exposure& e = exposures[v];
        for (std::size_t row = 0; row < 3; ++row)
            all[views[v].name].push_back({e[4 * row], e[4 * row + 1], e[4 * row + 2], e[4 * row + 3]});
    }
    return all;
}

}  // namespace

finding exposure_feature::analyze(const scene_statistics& statistics) const {
    const std::size_t photos = statistics.scene().train.size();
    const photo_brightness& brightness = statistics.brightness();
    std::vector<float> values = values_of(brightness, photos);
    if (brightness.points < enough_points)
        return {{}, too_few_points(brightness.points, "visible at a similar size"), "off", std::move(values)};
    const moving_evidence moving = find_moving_things(statistics);
    const std::vector<bool> left_out = moving.contributing_photos();
    std::vector<double> errors, apart;
    for (std::size_t v = 0; v < photos; ++v) {
        if (brightness.error[v] == 0 || left_out[v]) continue;
        errors.push_back(brightness.error[v]);
        apart.push_back(std::abs(brightness.log2[v]));
    }
    // Things that hide many points of a photo, or mix with rough parts, change the brightness of few photos.
    const bool is_doubtful = moving.is_clear() || brightness.is_rough;
    const double spread = is_doubtful ? typical_spread(apart) : root_mean_square(apart);
    const double error = median(errors);
    const bool varies = spread >= least_spread_in(statistics) && spread >= least_errors * error;
    return {
        varies,
        text("the brightness of the same points differs by %.1f %% between photos (standard error %.1f %%)",
             percent(spread), percent(error)),
        varies ? "on" : "off", std::move(values)};
}

explanation exposure_feature::explain(const scene_statistics& statistics, const finding&) const {
    const double least = least_spread_in(statistics);
    explanation made{.condition = text("the brightness differs by at least %.1f %%, and by at least %.0f "
                                       "standard errors",
                                       percent(least), least_errors)};
    const photo_brightness& brightness = statistics.brightness();
    std::vector<double> shown(brightness.log2.size(), std::nan(""));
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < shown.size(); ++v) {
        if (brightness.error[v] == 0) continue;
        shown[v] = percent(brightness.log2[v]);
        order.push_back(v);
    }
    if (order.empty()) return made;
    const auto last = static_cast<double>(shown.size());
    made.charts.push_back({"Brightness of photos relative to their mean (%)",
                           "photo",
                           {curve_of_photos("photo", shown),
                            level_line("typical difference that calls for exposure", last, percent(least)),
                            level_line("the same below the mean", last, percent(-least))}});
    std::ranges::sort(order, {}, [&](std::size_t v) { return shown[v]; });
    const auto add = [&](std::size_t v, const char* label) {
        made.photos.push_back(shown_photo(statistics.scene().train[v], label,
                                          text("Points in it: %+.1f %% brightness.", shown[v])));
    };
    add(order.front(), "Darkest photo");
    add(order.back(), "Brightest photo");
    return made;
}

std::vector<float> exposure_feature::neutral_values(const scene& scene) const {
    return values_of({}, scene.train.size());
}

void exposure_feature::schedule(const selected_feature& selected, train::training& training) const {
    if (!selected.on) return;
    const int views = static_cast<int>(training.scene().train.size());
    training.add({train::phase::upkeep, "normalize exposures",
                  [=, &training](int iteration) {
                      return iteration % views == 0 || iteration == training.schedule().iterations.last();
                  },
                  [&training](int) { training.engine().feature("exposure").normalize(); }});
}

show_function exposure_feature::show_on_host(train::engine& engine, const scene&) const {
    return [exposures = exposures_from(engine.feature(name()).values())](
               std::size_t view, const train::rendered_pixels&, std::vector<float>& render) {
        const exposure& e = exposures[view];
        const std::size_t pixels = render.size() / 3;
        for (std::size_t i = 0; i < pixels; ++i) {
            const std::array color{render[i], render[pixels + i], render[2 * pixels + i]};
            for (unsigned c = 0; c < 3; ++c) {
                float exposed = e[exposure_at(c, 3)];
                for (unsigned k = 0; k < 3; ++k) exposed += e[exposure_at(c, k)] * color[k];
                render[c * pixels + i] = exposed;
            }
        }
    };
}

void exposure_feature::before_evaluation(train::engine& engine, const scene& scene) const {
    auto& state = engine.feature(name());
    state.set_held_out_values(flattened(held_out_exposures(scene, exposures_from(state.values()))));
}

void exposure_feature::write_results(const selected_feature& selected, train::engine& engine,
                                     const scene& scene, const std::filesystem::path& folder) const {
    const auto file = folder / "exposures.json";
    if (!selected.on) {
        std::filesystem::remove(file);
        return;
    }
    const auto of_training = exposures_from(engine.feature(name()).values());
    const nlohmann::ordered_json all{{"train", to_json(scene.train, of_training)},
                                     {"test", to_json(scene.test, held_out_exposures(scene, of_training))}};
    write_json(file, all);
}

}  // namespace gs::features
