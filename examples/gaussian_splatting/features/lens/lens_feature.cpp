// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens_feature.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "../text.hpp"

namespace gs::features {
namespace {

/// Returns the angle between opposite corners of an image, in degrees. Panoramas have 360.
double diagonal_of(const camera& c) {
    if (c.is_panorama) return 360;
    const double corner =
        std::hypot(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
    const double half = c.fisheye ? c.fisheye->angle(corner) : std::atan(corner);
    return 360 / std::numbers::pi * half;
}

/// Returns how far the removed distortion moved a ray toward a corner of the photo: outward, in
/// pixels. `share`: of the distance to the corner.
double shift_of(const view& v, double share) {
    const camera& c = v.camera;
    const glm::dvec2 ray =
        share * glm::dvec2(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
    return c.fx * (glm::length(v.removed_distortion.distort(ray)) - glm::length(ray));
}

pages::line_chart distortion_chart(const view& v) {
    constexpr int steps = 50;
    pages::curve shift{"shift", {}};
    for (int i = 0; i <= steps; ++i)
        shift.points.emplace_back(100.0 * i / steps, shift_of(v, static_cast<double>(i) / steps));
    return {"Outward shift by lens distortion (pixels)",
            "distance from the center (% of the way to the corner)",
            {std::move(shift)}};
}

/// Returns the photo from which the strongest lens distortion was removed, or `end`.
std::vector<view>::const_iterator most_distorted(const std::vector<view>& views) {
    const auto found = std::ranges::max_element(views, {}, [](const view& v) {
        return v.removed_distortion.is_none() ? -1 : std::abs(shift_of(v, 1));
    });
    return found == views.end() || found->removed_distortion.is_none() ? views.end() : found;
}

/// Returns how far from the center rays appear, for a fisheye lens and for a pinhole camera.
pages::line_chart projection_chart(const fisheye& lens, double diagonal) {
    constexpr int steps = 60;
    const double most = std::min(lens.end(), diagonal * std::numbers::pi / 360), highest = lens.radius(most);
    pages::curve own{"fisheye lens", {}}, pinhole{"pinhole camera", {}};
    for (int i = 0; i <= steps; ++i) {
        const double angle = most * i / steps, degrees = 180 / std::numbers::pi * angle;
        own.points.emplace_back(degrees, lens.radius(angle));
        if (angle < std::numbers::pi / 2 && std::tan(angle) < 2 * highest)
            pinhole.points.emplace_back(degrees, std::tan(angle));
    }
    return {"Distance from the center (focal lengths)",
            "angle from the axis (degrees)",
            {std::move(own), std::move(pinhole)},
            true};
}

}  // namespace

finding lens_feature::analyze(const scene_statistics& statistics) const {
    std::size_t photos = 0, panoramas = 0;
    double widest = 0;  // largest angle from corner to corner, in degrees
    for (const view& v : statistics.scene().train) {
        const camera& c = v.camera;
        if (c.is_panorama) ++panoramas;
        if (!c.fisheye) continue;
        ++photos;
        widest = std::max(widest, diagonal_of(c));
    }
    const std::size_t all = statistics.scene().train.size();
    const std::string with_fisheye = text(
        "%zu of %zu photos have fisheye lenses with diagonals of up to %.0f degrees", photos, all, widest);
    const std::string are_panoramas = text("%zu of %zu photos are panoramas", panoramas, all);
    if (photos > 0 && panoramas > 0)
        return {true, with_fisheye + ", and " + are_panoramas, "fisheye and panorama"};
    if (photos > 0) return {true, with_fisheye, "fisheye"};
    if (panoramas > 0) return {true, are_panoramas, "panorama"};
    const auto distorted = std::ranges::count_if(
        statistics.scene().train, [](const view& v) { return !v.removed_distortion.is_none(); });
    if (distorted > 0)
        return {false,
                text("%zu of %zu photos had lens distortion, which loading removed",
                     static_cast<std::size_t>(distorted), all),
                "pinhole"};
    return {false, "all cameras are pinhole cameras", "pinhole"};
}

explanation lens_feature::explain(const scene_statistics& statistics, const finding&) const {
    explanation made{.condition = "the scene's files specify a fisheye lens or a panorama"};
    const std::vector<view>& views = statistics.scene().train;
    if (views.empty()) return made;
    std::vector<double> diagonals;
    for (const view& v : views) diagonals.push_back(diagonal_of(v.camera));
    made.charts.push_back(
        {"Angle between opposite corners (degrees)", "photo", {curve_of_photos("photo", diagonals)}, true});
    const auto add = [&](lens_model lens, const char* label, const char* note) {
        std::vector<std::size_t> found;
        for (std::size_t v = 0; v < views.size(); ++v)
            if (views[v].camera.lens() == lens) found.push_back(v);
        if (found.empty()) return;
        const std::size_t widest = std::ranges::max(found, {}, [&](std::size_t v) { return diagonals[v]; });
        const camera& c = views[widest].camera;
        if (c.fisheye) made.charts.push_back(projection_chart(*c.fisheye, diagonals[widest]));
        made.photos.push_back(shown_photo(views[widest], label, note));
    };
    add(lens_model::pinhole, "Widest pinhole photo",
        "Straight lines of the scene must be straight here. If they bend, the camera model of the files is "
        "wrong.");
    if (const auto distorted = most_distorted(views); distorted != views.end()) {
        made.charts.push_back(distortion_chart(*distorted));
        made.photos.push_back(shown_photo(*distorted, "Photo with the strongest distortion",
                                          text("Loading removed its lens distortion, which moved a corner by "
                                               "%.1f pixels.",
                                               std::abs(shift_of(*distorted, 1)))));
    }
    add(lens_model::fisheye, "Widest fisheye photo",
        "Straight lines of the scene bend around the center. If they are straight, the camera model of the "
        "files is wrong.");
    add(lens_model::panorama, "Panorama", "The left and the right border must show the same place.");
    return made;
}

}  // namespace gs::features
