// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "scene_statistics.hpp"

#include <algorithm>
#include <utility>

#include "../core/median.hpp"

namespace gs {
namespace {

observed_points smooth_part(observed_points points) {
    std::vector<double> roughness;
    for (const auto& seen : points)
        for (const observation& o : seen) roughness.push_back(o.roughness);
    constexpr double texture = 0.04, times_noise = 1.5;
    const double noise = quantile(roughness, 0.1);
    const double limit = std::min(quantile(roughness, 0.5), texture + times_noise * noise);
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return o.roughness > limit; });
        if (seen.size() < scene_statistics::least_photos_of_point) seen.clear();
    }
    std::erase_if(points, [](const auto& seen) { return seen.empty(); });
    return points;
}

}  // namespace

const photo_shifts& scene_statistics::shifts() const {
    constexpr std::size_t most_photos = 60;
    if (!shifts_) shifts_ = measure_shifts(scene_, most_photos);
    return *shifts_;
}

const std::vector<corrected_camera>& scene_statistics::cameras() const {
    if (cameras_) return *cameras_;
    if (shifts().are_clear()) {
        const bool has_all = shifts().examined == scene_.train.size();
        cameras_ = correct_poses(scene_, has_all ? shifts() : measure_shifts(scene_, scene_.train.size()));
    } else {
        cameras_.emplace();
        for (const view& v : scene_.train) cameras_->push_back({v.camera});
    }
    return *cameras_;
}

const observed_points& scene_statistics::points() const {
    if (points_) return *points_;
    std::vector<camera> poses;
    for (const corrected_camera& c : cameras()) poses.push_back(c.camera);
    points_ = observe_points(scene_, poses);
    return *points_;
}

const observed_points& scene_statistics::smooth_points() const {
    if (smooth_) return *smooth_;
    observed_points aligned = points();
    if (cameras_)
        for (auto& seen : aligned)
            std::erase_if(seen, [&](const observation& o) { return !(*cameras_)[o.view].is_aligned; });
    smooth_ = smooth_part(std::move(aligned));
    return *smooth_;
}

const photo_brightness& scene_statistics::brightness() const {
    constexpr std::size_t few = 100;
    constexpr float one_size = 2.2f;  // of footprints: see `keep_one_size`
    if (smooth_points().size() >= few) return brightness_of_smooth();
    if (brightness_) return *brightness_;
    observed_points all = points();
    for (auto& seen : all) keep_one_size(seen, one_size);
    std::erase_if(all, [](const auto& seen) { return seen.size() < least_photos_of_point; });
    if (all.size() <= smooth_points().size()) return brightness_of_smooth();
    brightness_ = measure_brightness(std::move(all));
    brightness_->is_rough = true;
    return *brightness_;
}

const photo_brightness& scene_statistics::brightness_of_smooth() const {
    if (!brightness_of_smooth_) brightness_of_smooth_ = measure_brightness(smooth_points());
    return *brightness_of_smooth_;
}

photo_brightness scene_statistics::measure_brightness(observed_points points) const {
    if (points.empty()) return {};
    remove_clear_falloff(points);
    return estimate_brightness(points, scene_.train.size());
}

const lens_falloff& scene_statistics::falloff() const {
    if (falloff_) return *falloff_;
    constexpr std::size_t few = 100;
    constexpr float slightly_rough = 0.3f;
    falloff_ = estimate_falloff(scene_, smooth_points());
    if (falloff_->points >= few) return *falloff_;
    observed_points more = points();
    for (auto& seen : more)
        std::erase_if(seen, [&](const observation& o) { return o.roughness > slightly_rough; });
    falloff_ = estimate_falloff(scene_, std::move(more));
    return *falloff_;
}

const tone_response& scene_statistics::response() const {
    if (response_) return *response_;
    observed_points points = smooth_points();
    remove_clear_falloff(points);
    response_ = estimate_response(scene_, std::move(points));
    return *response_;
}

void scene_statistics::remove_clear_falloff(observed_points& points) const {
    if (falloff().is_clear()) remove_falloff(scene_, falloff(), points);
}

}  // namespace gs
