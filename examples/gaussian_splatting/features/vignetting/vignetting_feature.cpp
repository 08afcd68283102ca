// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "vignetting_feature.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "../../core/median.hpp"
#include "../../core/write_json.hpp"
#include "../../engine/engine.hpp"
#include "../half_way/half_way_statistics.hpp"
#include "../text.hpp"
#include "lens_groups.hpp"

namespace gs::features {
namespace {

/// Errors of a half-trained model look like weak falloffs. It shows a falloff if this is strong, or large
/// compared with its standard error.
constexpr double strong_half_way = 0.13, errors_half_way = 15;
constexpr const char* has_alpha = "photos have transparent parts, whose background has no falloff";
constexpr const char* has_panoramas = "all photos are panoramas, which are put together from several photos";

/// Returns the share of the brightness that is lost in the corners, for a strength of `lens_falloff`.
double loss_of(double strength) { return 1 - std::exp(-strength); }

/// Returns the values for all lenses, if red, green and blue lose these shares in the corners.
std::vector<float> values_for(const scene& scene, const std::array<double, 3>& losses) {
    const lens_groups lenses(scene.train);
    falloff_values values({}, {});
    for (const view& v : scene.train) {
        const auto lens = lenses.of(v.camera);
        values.lens_of_view.push_back(lens ? static_cast<int>(*lens) : -1);
    }
    for (std::size_t lens = 0; lens < lenses.count(); ++lens)
        for (const double loss : losses) {
            // Equal terms are 1 / (1 + q u), because the sum of their polynomials is 3 u.
            const double q = 1 / (1 - std::max(loss, 0.0)) - 1;
            values.parameters.insert(values.parameters.end(), falloff_terms,
                                     static_cast<float>(q / falloff_terms));
        }
    return values.flattened();
}

float factor_at(double square_radius, const float* parameters) {
    float basis[falloff_terms];
    falloff_basis(static_cast<float>(square_radius), basis);
    return falloff(basis, parameters);
}

nlohmann::ordered_json to_json(const camera& lens, std::size_t photos, const float* parameters) {
    nlohmann::ordered_json made{{"photos", photos}, {"width", lens.width}, {"height", lens.height}};
    for (unsigned c = 0; c < 3; ++c) {
        auto& factors = made["falloff"][std::array{"red", "green", "blue"}[c]];
        for (int tenth = 0; tenth <= 10; ++tenth)
            factors.push_back(factor_at(tenth * tenth / 100.0, parameters + falloff_at(c, 0)));
    }
    return made;
}

/// Returns the photo that shows most of the tenth of the observations that are farthest from the centers,
/// with rings around its points.
pages::marked_photo widest_photo(const scene& scene, const observed_points& points) {
    struct place {
        std::size_t view;
        double square_radius;
        pages::mark ring;
    };
    std::vector<place> places;
    std::vector<double> radii;
    for (const auto& seen : points)
        for (const observation& o : seen) {
            const camera& c = scene.train[o.view].camera;
            if (c.is_panorama) continue;
            const pages::mark ring = ring_around(o);
            places.push_back({o.view, square_radius(c, ring.left, ring.top), ring});
            radii.push_back(places.back().square_radius);
        }
    const double far = quantile(radii, 0.9);
    std::vector<std::vector<pages::mark>> marks(scene.train.size());
    for (const place& p : places)
        if (p.square_radius >= far) marks[p.view].push_back(p.ring);
    const auto most = std::ranges::max_element(marks, {}, &std::vector<pages::mark>::size);
    const std::size_t count = most->size();
    return shown_photo(
        scene.train[static_cast<std::size_t>(most - marks.begin())], "Most points near the corners",
        text("Rings: %zu points, which other photos show nearer to their centers.", count), std::move(*most));
}

/// Returns the finding from a falloff, which calls for the effect if `is_clear`. `compared`: what photos show
/// at different places.
finding finding_from(const scene& scene, const lens_falloff& found, bool is_clear, const char* compared) {
    std::array<double, 3> losses{};
    for (std::size_t c = 0; c < 3; ++c) losses[c] = is_clear ? loss_of(found.channels[c]) : 0;
    return {
        is_clear,
        text("the same %s are %.1f %% %s in corners than in the center (standard error %.1f %%)%s", compared,
             100 * std::abs(loss_of(found.strength.value)), found.strength.value < 0 ? "brighter" : "darker",
             100 * found.strength.error,
             found.is_strong() && !found.is_clear() ? ", but not on all sides, or only from some directions"
                                                    : ""),
        is_clear ? "on" : "off", values_for(scene, losses)};
}

}  // namespace

finding vignetting_feature::analyze(const scene_statistics& statistics) const {
    const scene& scene = statistics.scene();
    if (const std::string reason = obstacle(scene, {}); !reason.empty())
        return {false, reason, "off", neutral_values(scene)};
    const lens_falloff& found = statistics.falloff();
    if (found.points < enough_points)
        return {{}, too_few_points(found.points, "in smooth areas"), "off", neutral_values(scene)};
    return finding_from(scene, found, found.is_clear(), "points");
}

finding vignetting_feature::review(const half_way_statistics& statistics) const {
    const lens_falloff& found = statistics.falloff();
    if (found.points < enough_parts)
        return {{}, too_few_parts(found.points, "smooth parts"), "off", neutral_values(statistics.scene())};
    const auto& [strength, error] = found.strength;
    const bool is_clear =
        found.is_clear() && (strength >= strong_half_way || strength >= errors_half_way * error);
    return finding_from(statistics.scene(), found, is_clear, "parts of the model");
}

explanation vignetting_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition = text("points are at least %.0f %% darker in corners, by at least %.0f standard errors, "
                          "on all sides and whatever their direction",
                          100 * loss_of(lens_falloff::least_strength), lens_falloff::least_errors)};
    const scene& scene = statistics.scene();
    if (!obstacle(scene, {}).empty()) return made;
    const lens_falloff& found = statistics.falloff();
    if (found.profile.empty()) return made;
    pages::curve measured{"measured at points", {}}, fitted{"fitted", {}};
    for (const auto& [radius, brightness] : found.profile)
        measured.points.emplace_back(100 * radius, 100 * brightness);
    for (int tenth = 0; tenth <= 10; ++tenth)
        fitted.points.emplace_back(10 * tenth, 100 * std::exp(-found.strength.value * tenth * tenth / 100.0));
    made.charts.push_back({"Brightness of the same points (%)",
                           "distance from the center (% of that of the corners)",
                           {std::move(measured), std::move(fitted)}});
    made.photos.push_back(widest_photo(scene, statistics.smooth_points()));
    return made;
}

std::vector<float> vignetting_feature::neutral_values(const scene& scene) const {
    return values_for(scene, {});
}

std::string vignetting_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    if (scene.has_alpha) return has_alpha;
    return lens_groups(scene.train).count() == 0 ? has_panoramas : "";
}

show_function vignetting_feature::show_on_host(train::engine& engine, const scene& scene) const {
    return
        [&views = scene.train, values = falloff_values(engine.feature(name()).values(), scene.train.size())](
            std::size_t view, const train::rendered_pixels& shown, std::vector<float>& render) {
            const int lens = values.lens_of_view[view];
            if (lens < 0) return;
            const std::size_t pixels = render.size() / 3;
            const camera c = views[view].camera.resized(shown.width, shown.height);
            for (std::size_t i = 0; i < pixels; ++i) {
                const glm::dvec2 place = shown.center(i);
                const double u = square_radius(c, place.x, place.y);
                for (unsigned channel = 0; channel < 3; ++channel)
                    render[channel * pixels + i] *= factor_at(u, values.of(lens) + falloff_at(channel, 0));
            }
        };
}

void vignetting_feature::before_evaluation(train::engine& engine, const scene& scene) const {
    auto& state = engine.feature(name());
    const falloff_values values(state.values(), scene.train.size());
    const lens_groups lenses(scene.train);
    std::vector<held_out_falloff> held_out(scene.test.size());
    for (std::size_t v = 0; v < scene.test.size(); ++v) {
        const camera& c = scene.test[v].camera;
        const auto lens = lenses.of(c);
        if (!lens) continue;
        held_out[v].geometry = geometry_of(c);
        std::copy_n(values.of(static_cast<int>(*lens)), falloff_width, held_out[v].parameters.begin());
    }
    state.set_held_out_values(flattened(held_out));
}

void vignetting_feature::write_results(const selected_feature& selected, train::engine& engine,
                                       const scene& scene, const std::filesystem::path& folder) const {
    const auto file = folder / "vignetting.json";
    if (!selected.on) {
        std::filesystem::remove(file);
        return;
    }
    const falloff_values values(engine.feature(name()).values(), scene.train.size());
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
