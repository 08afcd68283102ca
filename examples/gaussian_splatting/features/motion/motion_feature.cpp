// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "motion_feature.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "../../core/write_json.hpp"
#include "../../training/training.hpp"
#include "../text.hpp"
#include "motion_evidence.hpp"

namespace gs::features {
namespace {

/// Returns initial values: motions that turn the cameras. `blurs`: of each photo, in pixels.
std::vector<float> initial_values(const scene& scene, const std::vector<glm::dvec2>& blurs) {
    std::vector<float> values;
    const std::vector<motion_scale> scales = motion_scales(scene);
    for (std::size_t v = 0; v < scales.size(); ++v) {
        const glm::vec2 blur(blurs[v]);
        const auto [depth, angle] = scales[v];
        values.insert(values.end(),
                      {static_cast<float>(depth), static_cast<float>(angle), -blur.y, blur.x, 0, 0, 0, 0});
    }
    return values;
}

/// Returns the measured blurs. Photos without significant blur get a small one.
std::vector<glm::dvec2> initial_blurs(const motion_evidence& found) {
    std::vector<glm::dvec2> blurs;
    for (const photo_blur& photo : found.photos) {
        const double length = glm::length(photo.motion);
        const glm::dvec2 direction = length > 0 ? photo.motion / length : glm::dvec2(1, 0);
        blurs.push_back((photo.is_clear() ? length : static_cast<double>(small_motion)) * direction);
    }
    return blurs;
}

double longest_blur(const motion_evidence& found) {
    double longest = 0;
    for (const photo_blur& photo : found.photos)
        if (photo.is_clear()) longest = std::max(longest, glm::length(photo.motion));
    return longest;
}

}  // namespace

finding motion_feature::analyze(const scene_statistics& statistics) const {
    const scene& scene = statistics.scene();
    if (const std::string reason = obstacle(scene, {}); !reason.empty()) return {false, reason, "off"};
    const motion_evidence found = find_motion_blur(statistics);
    std::vector<float> values = initial_values(scene, initial_blurs(found));
    if (found.judged() < motion_evidence::least_photos)
        return {{},
                text("cannot decide: %zu photos have clear edges in all directions", found.judged()),
                "off",
                std::move(values)};
    const std::string evidence =
        found.blurred() == 0
            ? text("no photo has wider edges in one direction than the other photos")
            : text(
                  "%zu of %zu photos have wider edges in one direction than the others, by up to %.1f "
                  "pixels",
                  found.blurred(), found.judged(), longest_blur(found));
    return {found.is_clear(), evidence, found.is_clear() ? "on" : "off", std::move(values)};
}

explanation motion_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition =
            text("motions have widened the edges of at least %zu photos, and of %.0f %% of them, by at "
                 "least %.0f pixels and %.1f standard errors",
                 motion_evidence::least_blurred, 100 * motion_evidence::least_share,
                 motion_evidence::least_blur, motion_evidence::least_errors)};
    const scene& scene = statistics.scene();
    if (!obstacle(scene, {}).empty()) return made;
    const motion_evidence found = find_motion_blur(statistics);
    std::vector<double> lengths;
    std::vector<std::size_t> order;
    for (const photo_blur& photo : found.photos) {
        if (photo.is_judged) order.push_back(lengths.size());
        lengths.push_back(photo.is_judged ? glm::length(photo.motion) : std::nan(""));
    }
    if (order.empty()) return made;
    made.charts.push_back({"Width of edges in one direction, relative to other photos (pixels)",
                           "photo",
                           {curve_of_photos("photo", lengths),
                            level_line("width that calls for the effect, if it is significant",
                                       static_cast<double>(lengths.size()), motion_evidence::least_blur)},
                           true});
    // The photos with significant blur come first.
    std::ranges::sort(order, std::greater(),
                      [&](std::size_t v) { return std::pair(found.photos[v].is_clear(), lengths[v]); });
    order.resize(std::min<std::size_t>(order.size(), 3));
    for (const std::size_t v : order) {
        const photo_blur& photo = found.photos[v];
        if (v != order.front() && !photo.is_clear()) break;
        const double angle = std::atan2(-photo.motion.y, photo.motion.x) * 180 / std::numbers::pi;
        made.photos.push_back(shown_photo(
            scene.train[v], v == order.front() ? "Widest edges" : "Wider edges",
            text("Edges are %.1f pixels wider in the direction of %.0f degrees from the horizontal%s.",
                 lengths[v], angle, photo.is_clear() ? "" : ", which may be chance")));
    }
    return made;
}

std::vector<float> motion_feature::neutral_values(const scene& scene) const {
    return initial_values(scene, std::vector<glm::dvec2>(scene.train.size(), glm::dvec2(small_motion)));
}

std::string motion_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    if (std::ranges::none_of(scene.train, [](const view& v) { return v.camera.is_panorama; })) return {};
    return "the motion of cameras is not simulated in panoramas, which are put together from several photos";
}

void motion_feature::schedule(const selected_feature& selected, train::training& training) const {
    if (!selected.on) return;
    const int views = static_cast<int>(training.scene().train.size());
    training.add({train::phase::upkeep, "share the readout time of photos",
                  [=](int iteration) { return iteration % views == 0; },
                  [&training](int) {
                      auto& state = training.engine().feature("motion");
                      std::vector<float> values = state.values();
                      share_readout(values);
                      state.change_values(values);
                  }});
}

void motion_feature::write_results(const selected_feature& selected, train::engine& engine,
                                   const scene& scene, const std::filesystem::path& folder) const {
    const auto file = folder / "motion.json";
    if (!selected.on) {
        std::filesystem::remove(file);
        return;
    }
    const std::vector<motion_scale> scales = motion_scales(scene);
    auto all = nlohmann::ordered_json::object();
    for (std::size_t v = 0; v < scene.train.size(); ++v) {
        const camera seen = engine.cameras().training_camera(v, scene.train[v].camera);
        const camera_motion motion = seen.motion.value_or(camera_motion{});
        const glm::dvec2 blur = blur_of(seen, motion, scales[v].depth);
        const glm::dvec3 shift = scene.normalization.scale * motion.shift;
        all[scene.train[v].name] = {{"blur", {blur.x, blur.y}},
                                    {"turn", {motion.turn.x, motion.turn.y, motion.turn.z}},
                                    {"shift", {shift.x, shift.y, shift.z}},
                                    {"readout", motion.readout}};
    }
    write_json(file, all);
}

}  // namespace gs::features
