// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "response_feature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "../../core/write_json.hpp"
#include "../../engine/engine.hpp"
#include "../exposure/exposure_feature.hpp"
#include "../half_way/half_way_statistics.hpp"
#include "../text.hpp"
#include "../vignetting/lens_groups.hpp"
#include "respond_in_model.hpp"

namespace gs::features {
namespace {

constexpr const char* has_alpha = "photos have transparent parts, whose background has no response";
constexpr const char* has_panoramas = "all photos are panoramas, which are put together from several photos";
constexpr const char* needs_exposure = "the brightness of photos does not differ enough to show a response";

nlohmann::ordered_json to_json(const camera& lens, std::size_t photos, const float* increments) {
    constexpr int samples = 20;
    nlohmann::ordered_json made{{"photos", photos}, {"width", lens.width}, {"height", lens.height}};
    for (unsigned c = 0; c < 3; ++c) {
        auto& curve = made["response"][std::array{"red", "green", "blue"}[c]];
        for (int i = 0; i <= samples; ++i)
            curve.push_back(respond(static_cast<float>(i) / samples, increments + response_at(c, 0)));
    }
    return made;
}

/// Returns why the evidence does not suffice, or an empty string.
std::string doubt(const tone_response& found) {
    if (found.is_clear()) return "";
    if (found.strength < tone_response::least_strength) return ", which is little";
    return ", but not clearly in each half of the photos";
}

/// Returns the finding from a response. `compared`: what photos show in different brightness.
finding finding_from(const tone_response& found, const char* compared, std::vector<float> values) {
    return {found.is_clear(),
            text("a tone curve explains differences of %.1f %% between the same %s, beyond their colors and "
                 "the exposures (%.1f standard errors)%s",
                 100 * found.strength, compared, found.errors(), doubt(found).c_str()),
            found.is_clear() ? "on" : "off", std::move(values)};
}

bool exposures_differ(const scene_statistics& statistics) {
    return exposure_feature().analyze(statistics).recommended == true;
}

/// Adds the photos that differ most in brightness.
void add_extremes(const scene_statistics& statistics, explanation& made) {
    const std::vector<double>& brightness = statistics.brightness().log2;
    std::vector<std::size_t> measured;
    for (std::size_t v = 0; v < brightness.size(); ++v)
        if (statistics.brightness().error[v] > 0) measured.push_back(v);
    if (measured.size() < 2) return;
    const auto [darkest, brightest] =
        std::ranges::minmax_element(measured, {}, [&](std::size_t v) { return brightness[v]; });
    const auto add = [&](std::size_t view, const char* label) {
        made.photos.push_back(
            shown_photo(statistics.scene().train[view], label,
                        text("Points in it: %+.1f %% brightness.", 100 * (std::exp2(brightness[view]) - 1))));
    };
    add(*darkest, "Darkest photo");
    add(*brightest, "Brightest photo");
}

}  // namespace

finding response_feature::analyze(const scene_statistics& statistics) const {
    const scene& scene = statistics.scene();
    std::vector<float> values = neutral_values(scene);
    if (const std::string reason = obstacle(scene, {}); !reason.empty())
        return {false, reason, "off", std::move(values)};
    if (const std::size_t points = statistics.brightness().points; points < enough_points)
        return {{}, too_few_points(points, "visible at a similar size"), "off", std::move(values)};
    if (!exposures_differ(statistics)) return {false, needs_exposure, "off", std::move(values)};
    const tone_response& found = statistics.response();
    if (found.points < enough_points)
        return {{}, too_few_points(found.points, "in smooth areas"), "off", std::move(values)};
    return finding_from(found, "points", std::move(values));
}

finding response_feature::review(const half_way_statistics& statistics) const {
    const tone_response& found = statistics.response();
    std::vector<float> values = neutral_values(statistics.scene());
    if (found.points < enough_parts)
        return {{}, too_few_parts(found.points, "smooth parts"), "off", std::move(values)};
    return finding_from(found, "parts of the model", std::move(values));
}

explanation response_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition =
            text("the exposures of photos differ, and a tone curve explains differences of at least "
                 "%.1f %% and %.0f standard errors; the curve of each half of the photos must fit the "
                 "other half",
                 100 * tone_response::least_strength, tone_response::least_errors)};
    if (!obstacle(statistics.scene(), {}).empty() || statistics.smooth_points().empty()) return made;
    add_extremes(statistics, made);
    const tone_response& found = statistics.response();
    if (found.points < enough_points) return made;
    pages::curve measured{"measured at points", {}}, none{"without a response", {}};
    for (int percent = 0; percent <= 100; percent += 5) {
        measured.points.emplace_back(percent, 100 * found.at(percent / 100.0));
        none.points.emplace_back(percent, percent);
    }
    made.charts.push_back({"Brightness in the photo (%)",
                           "brightness that colors and exposures predict (%)",
                           {std::move(measured), std::move(none)}});
    return made;
}

std::vector<float> response_feature::neutral_values(const scene& scene) const {
    const lens_groups lenses(scene.train);
    response_values values({}, std::vector<float>(lenses.count() * response_width, 1.0f / response_degree));
    for (const view& v : scene.train) {
        const auto lens = lenses.of(v.camera);
        values.lens_of_view.push_back(lens ? static_cast<int>(*lens) : -1);
    }
    return values.flattened();
}

std::string response_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    if (scene.has_alpha) return has_alpha;
    return lens_groups(scene.train).count() == 0 ? has_panoramas : "";
}

show_function response_feature::show_on_host(train::engine& engine, const scene& scene) const {
    return [values = response_values(engine.feature(name()).values(), scene.train.size())](
               std::size_t view, const train::rendered_pixels&, std::vector<float>& render) {
        const int lens = values.lens_of_view[view];
        if (lens < 0) return;
        const std::size_t pixels = render.size() / 3;
        for (unsigned c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < pixels; ++i) {
                float& x = render[c * pixels + i];
                x = respond(x, values.of(lens) + response_at(c, 0));
            }
    };
}

void response_feature::before_evaluation(train::engine& engine, const scene& scene) const {
    auto& state = engine.feature(name());
    const response_values values(state.values(), scene.train.size());
    const lens_groups lenses(scene.train);
    std::vector<float> held_out(scene.test.size() * response_width);
    for (std::size_t v = 0; v < scene.test.size(); ++v)
        if (const auto lens = lenses.of(scene.test[v].camera))
            std::copy_n(values.of(static_cast<int>(*lens)), response_width,
                        held_out.begin() + static_cast<std::ptrdiff_t>(v * response_width));
    state.set_held_out_values(held_out);
}

void response_feature::before_saving(train::engine& engine, const scene& scene, gaussians& model) const {
    const response_values values(engine.feature(name()).values(), scene.train.size());
    std::vector<std::size_t> photos(lens_groups(scene.train).count());
    for (const int lens : values.lens_of_view)
        if (lens >= 0) ++photos[static_cast<std::size_t>(lens)];
    const auto most = std::ranges::max_element(photos) - photos.begin();
    respond_in_model(values.of(static_cast<int>(most)), model);
}

void response_feature::write_results(const selected_feature& selected, train::engine& engine,
                                     const scene& scene, const std::filesystem::path& folder) const {
    const auto file = folder / "response.json";
    if (!selected.on) {
        std::filesystem::remove(file);
        return;
    }
    const response_values values(engine.feature(name()).values(), scene.train.size());
    const lens_groups lenses(scene.train);
    auto all = nlohmann::ordered_json::array();
    for (std::size_t lens = 0; lens < lenses.count(); ++lens) {
        const auto index = static_cast<int>(lens);
        const auto photos = std::ranges::count(values.lens_of_view, index);
        all.push_back(to_json(lenses.first(lens), static_cast<std::size_t>(photos), values.of(index)));
    }
    write_json(file, {{"lenses", all}});
}

}  // namespace gs::features
