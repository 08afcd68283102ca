// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "poses_feature.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "../../core/write_json.hpp"
#include "../../training/training.hpp"
#include "../text.hpp"

namespace gs::features {
namespace {

/// Returns the angle between two rotations, in degrees.
double degrees_between(const glm::dmat3& a, const glm::dmat3& b) {
    const glm::dmat3 turn = a * glm::transpose(b);
    const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
    // The sine is exact for small angles, and the cosine is not.
    const glm::dvec3 axis(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
    return std::atan2(glm::length(axis) / 2, cosine) * 180 / std::numbers::pi;
}

nlohmann::ordered_json to_json(const camera& given, const camera& learned, const normalization& world) {
    const glm::dvec3 center = world.to_world(learned.center());
    nlohmann::ordered_json pose;
    for (int row = 0; row < 3; ++row)  // the columns of camera-to-world rotations are rows here
        pose["camera_to_world"].push_back(
            {learned.rotation[row][0], learned.rotation[row][1], learned.rotation[row][2], center[row]});
    pose["turned_by_degrees"] = degrees_between(learned.rotation, given.rotation);
    pose["moved_by"] = world.scale * glm::length(learned.center() - given.center());
    return pose;
}

/// Training begins from the given poses. The smaller the shift of the photos, in pixels, the smaller are
/// steps, down to those from corrected poses.
std::vector<pose_start> given_starts(const scene& scene, double shift) {
    constexpr double steps_per_error = 10;
    std::vector<pose_start> starts;
    for (const view& v : scene.train) {
        const auto step = static_cast<float>(shift / v.camera.fx / steps_per_error);
        starts.push_back({{}, std::clamp(step, step_from_corrected, step_from_given)});
    }
    return starts;
}

/// Training begins from poses that show the points at their places. Photos that do not show them begin with
/// their given poses.
std::vector<pose_start> corrected_starts(const std::vector<given_pose>& given,
                                         const std::vector<corrected_camera>& corrected) {
    std::vector<std::optional<camera>> cameras;
    for (const corrected_camera& c : corrected)
        cameras.push_back(c.is_aligned ? std::optional(c.camera) : std::nullopt);
    std::vector<pose_start> starts;
    for (const auto& change : changes_to(cameras, given))
        starts.push_back(change ? pose_start{*change, step_from_corrected} : pose_start{});
    return starts;
}

/// Removes the motion that poses have in common since training began. Corrected poses fit the points, so
/// their first changes stay.
void remove_drift(const std::vector<given_pose>& given, const std::vector<pose_start>& starts,
                  std::vector<float>& changes) {
    const auto add_first = [&](float factor) {
        for (std::size_t i = 0; i < changes.size(); ++i)
            changes[i] += factor * starts[i / pose_width].change[i % pose_width];
    };
    add_first(-1);
    remove_common_motion(given, changes);
    add_first(1);
}

}  // namespace

finding poses_feature::analyze(const scene_statistics& statistics) const {
    const scene& scene = statistics.scene();
    if (const std::string reason = obstacle(scene, {}); !reason.empty()) return {false, reason, "off"};
    const photo_shifts& found = statistics.shifts();
    if (!found.are_decided())
        return {{},
                text("cannot decide: only %zu of %zu photos clearly show the colors of points",
                     found.judged(), found.examined),
                "off",
                neutral_values(scene)};
    const std::string evidence =
        text("the median of %zu photos shows the colors of points %.2f pixels beside their places",
             found.judged(), found.median_shift());
    const std::vector<given_pose> given = given_poses(scene);
    if (!found.are_clear())
        return {false, evidence, "off", initial_values(given, given_starts(scene, found.median_shift()))};
    const std::vector<corrected_camera>& cameras = statistics.cameras();
    return {true, evidence,
            text("on, beginning with the corrected poses of %zu of %zu photos",
                 static_cast<std::size_t>(std::ranges::count(cameras, true, &corrected_camera::is_aligned)),
                 cameras.size()),
            initial_values(given, corrected_starts(given, cameras))};
}

explanation poses_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{
        .condition =
            text("the median photo shows the colors of points at least %.0f pixel beside their places, "
                 "and at least %zu photos and a third of all clearly show them",
                 photo_shifts::least_shift, photo_shifts::least_photos)};
    const scene& scene = statistics.scene();
    const photo_shifts& found = statistics.shifts();
    if (found.judged() == 0) return made;
    std::vector<double> lengths;
    for (const photo_shift& p : found.photos)
        lengths.push_back(p.is_judged ? glm::length(p.pixels) : std::nan(""));
    made.charts.push_back({"Shift of photos against the points (pixels)",
                           "photo",
                           {curve_of_photos("photo", lengths),
                            level_line("shift that calls for the effect, if the median photo has it",
                                       static_cast<double>(lengths.size()), photo_shifts::least_shift)},
                           true});
    const auto most = static_cast<std::size_t>(
        std::ranges::max_element(lengths, {}, [](double x) { return std::isnan(x) ? -1 : x; }) -
        lengths.begin());
    const glm::dvec2 shift = found.photos[most].pixels;
    made.photos.push_back(shown_photo(
        scene.train[most], "Largest shift",
        text("The points lie %.1f pixels %s of their colors and %.1f pixels %s them.", std::abs(shift.x),
             shift.x > 0 ? "left" : "right", std::abs(shift.y), shift.y > 0 ? "above" : "below")));
    return made;
}

std::vector<float> poses_feature::neutral_values(const scene& scene) const {
    const std::vector<given_pose> given = given_poses(scene);
    return initial_values(given, std::vector<pose_start>(given.size()));
}

std::string poses_feature::obstacle(const scene& scene, const std::vector<float>&) const {
    constexpr std::size_t least_views = 4;  // fewer have hardly any changes besides a common motion
    if (scene.train.size() >= least_views) return {};
    return "to correct poses takes at least " + std::to_string(least_views) + " training photos";
}

void poses_feature::schedule(const selected_feature& selected, train::training& training) const {
    if (!selected.on || selected.values.empty()) return;
    const auto values = std::make_shared<std::vector<float>>(selected.values);
    training.add_state_before_engine([values, &training](state_archive& archive) {
        if (archive.loads() && !archive.has("poses.starts")) return;
        archive.exchange("poses.starts", *values);  // the changes of a checkpoint belong to its starts
        if (archive.loads()) training.engine().feature("poses").set_values(*values);
    });
    const std::vector<given_pose> given = given_poses(training.scene());
    const int views = static_cast<int>(given.size());
    training.add({train::phase::upkeep, "remove the common motion of poses",
                  // Not in the last steps, in which the Gaussians could not follow.
                  [=, &training](int iteration) {
                      return iteration % views == 0 &&
                             iteration + views <= training.schedule().iterations.last();
                  },
                  [given, values, &training](int) {
                      auto& state = training.engine().feature("poses");
                      std::vector<float> changes = state.values();
                      remove_drift(given, starts_in(*values), changes);
                      state.change_values(changes);
                  }});
}

void poses_feature::write_results(const selected_feature& selected, train::engine& engine, const scene& scene,
                                  const std::filesystem::path& folder) const {
    const auto file = folder / "poses.json";
    if (!selected.on) {
        std::filesystem::remove(file);
        return;
    }
    auto all = nlohmann::ordered_json::object();
    for (std::size_t v = 0; v < scene.train.size(); ++v) {
        const camera& given = scene.train[v].camera;
        all[scene.train[v].name] =
            to_json(given, engine.cameras().training_camera(v, given), scene.normalization);
    }
    write_json(file, all);
}

}  // namespace gs::features
