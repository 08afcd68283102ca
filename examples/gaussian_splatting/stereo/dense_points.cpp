// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "dense_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "../core/parallel.hpp"
#include "plane_sweep.hpp"

namespace gs::stereo {
namespace {

constexpr int longer_side = 192, coarse_side = 96;
constexpr std::size_t least_points = 20;  ///< that tell the distances in a photo
constexpr std::size_t most_photos = 400, most_others = 4;
constexpr int least_steps = 32, most_steps = 320;
/// The angle at the surface between two views that compare best, and the limits.
constexpr double best_angle = 8, least_angle = 1, most_angle = 35;  // degrees
constexpr double most_turn = 60;                                    // degrees between the axes of two cameras

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)) * 180 /
           std::numbers::pi;
}

/// The distances of the surfaces in a photo.
struct distances {
    double nearest, typical, farthest;
    bool are_known = true;  ///< whether points tell them
};

/// Returns the distances of surfaces with these points, which are a sample, with margins.
distances around(std::vector<double> found) {
    std::ranges::sort(found);
    const auto at = [&](double share) {
        return found[static_cast<std::size_t>(share * static_cast<double>(found.size() - 1))];
    };
    return {0.7 * at(0.01), at(0.5), 2 * at(0.99)};
}

distances distances_in(const scene& of, const camera& c) {
    constexpr std::size_t most_points = 20000;
    const std::size_t step = of.points.size() / most_points + 1;
    std::vector<double> found;
    for (std::size_t i = 0; i < of.points.size(); i += step)
        if (const auto seen = c.see(of.points[i].position);
            seen && seen->x >= 0 && seen->y >= 0 && seen->x < c.width && seen->y < c.height)
            found.push_back(glm::distance(of.points[i].position, c.center()));
    if (found.size() < least_points) {
        const double extent = of.extent();
        const auto center = of.looked_at();
        const double typical = center ? glm::distance(*center, c.center()) : extent;
        return {typical / 5, typical, 20 * std::max(typical, extent), false};
    }
    return around(std::move(found));
}

/// Returns at most `most_photos` training views, evenly from all.
std::vector<const view*> chosen_views(const scene& of) {
    const std::size_t count = std::min(of.train.size(), most_photos);
    std::vector<const view*> chosen;
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(&of.train[i * of.train.size() / count]);
    return chosen;
}

/// Returns the views that compare best with a view, the best first.
std::vector<std::size_t> others_of(const std::vector<const view*>& views, std::size_t which, double typical) {
    const camera& c = views[which]->camera;
    const glm::dvec3 axis = c.ray(0.5 * c.width, 0.5 * c.height), target = c.center() + typical * axis;
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t v = 0; v < views.size(); ++v) {
        const camera& other = views[v]->camera;
        if (v == which) continue;
        const double angle = degrees_between(target - c.center(), target - other.center());
        if (angle < least_angle || angle > most_angle) continue;
        const auto seen = other.see(target);
        const bool is_inside =
            seen && seen->x >= 0 && seen->y >= 0 && seen->x < other.width && seen->y < other.height;
        const bool is_turned =
            degrees_between(axis, other.ray(0.5 * other.width, 0.5 * other.height)) > most_turn;
        if (is_inside && (!is_turned || other.is_panorama))
            found.emplace_back(std::abs(std::log(angle / best_angle)), v);
    }
    std::ranges::sort(found);
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < std::min(found.size(), most_others); ++i) others.push_back(found[i].second);
    return others;
}

/// A photo with the surfaces that it shows.
struct swept_view {
    small_view photo;
    std::vector<std::size_t> others;
    bool has_known_range = true;
    sweep_range range;
    std::vector<float> inverse;  ///< inverse distance by pixel, or 0
    std::vector<bool> is_taken;  ///< whether a point already stands for the pixel

    glm::dvec3 point(std::size_t pixel) const {
        return photo.camera.center() + glm::dvec3(photo.ray[pixel]) / static_cast<double>(inverse[pixel]);
    }
};

/// Returns steps that move a surface by at most a pixel in each of the other photos.
int steps_for(const swept_view& view, const std::vector<swept_view>& all) {
    double pixels = 0;
    for (const std::size_t v : view.others) {
        const camera& other = all[v].photo.camera;
        const double apart = glm::distance(view.photo.camera.center(), other.center());
        pixels = std::max(pixels, apart * std::max(other.fx, other.fy));
    }
    const double steps = std::ceil(pixels * (view.range.nearest - view.range.farthest));
    return static_cast<int>(std::clamp<double>(steps, least_steps, most_steps));
}

/// Sweeps a view at its size, over its range.
void sweep_view(std::vector<swept_view>& views, std::size_t which) {
    swept_view& view = views[which];
    view.range.steps = steps_for(view, views);
    std::vector<const small_view*> others;
    for (const std::size_t other : view.others) others.push_back(&views[other].photo);
    view.inverse =
        others.empty() ? std::vector<float>(view.photo.pixels()) : sweep(view.photo, others, view.range);
}

/// Returns the training views at this size, with their ranges, and the views to compare them with.
std::vector<swept_view> prepared(const scene& of, const std::vector<const view*>& chosen, int size) {
    std::vector<swept_view> views(chosen.size());
    for_each_in_parallel(views.size(), [&](std::size_t v) {
        const distances found = distances_in(of, chosen[v]->camera);
        views[v].photo = reduced(*chosen[v], size);
        views[v].others = others_of(chosen, v, found.typical);
        views[v].has_known_range = found.are_known;
        views[v].range = {1 / found.farthest, 1 / found.nearest};
        views[v].is_taken.resize(views[v].photo.pixels());
    });
    return views;
}

/// Narrows the ranges that no points tell: to the distances that a sweep of smaller photos finds.
void narrow_ranges(std::vector<swept_view>& views, std::vector<swept_view> small) {
    for_each_in_parallel(views.size(), [&](std::size_t v) {
        if (views[v].has_known_range) return;
        sweep_view(small, v);
        std::vector<double> found;
        for (const float inverse : small[v].inverse)
            if (inverse > 0) found.push_back(1 / static_cast<double>(inverse));
        if (found.size() < least_points) return;
        const distances narrow = around(std::move(found));
        views[v].range = {std::max(views[v].range.farthest, 1 / narrow.farthest),
                          std::min(views[v].range.nearest, 1 / narrow.nearest)};
    });
}

/// Returns the pixel of a view that shows the point at about the same distance, or none.
std::optional<std::size_t> pixel_that_agrees(const swept_view& with, const glm::dvec3& point) {
    constexpr double most_steps_apart = 2;
    const camera& c = with.photo.camera;
    const auto seen = c.see(point);
    if (!seen || !(seen->x >= 0 && seen->y >= 0 && seen->x < c.width && seen->y < c.height)) return {};
    const std::size_t pixel =
        static_cast<std::size_t>(seen->y) * with.photo.width() + static_cast<std::size_t>(seen->x);
    if (with.inverse[pixel] == 0) return {};
    const double inverse = 1 / glm::distance(point, c.center());
    const double step = (with.range.nearest - with.range.farthest) / (with.range.steps - 1);
    if (std::abs(inverse - static_cast<double>(with.inverse[pixel])) > most_steps_apart * step) return {};
    return pixel;
}

}  // namespace

std::vector<colored_point> dense_points(const scene& of) {
    const std::vector<const view*> chosen = chosen_views(of);
    std::vector<swept_view> views = prepared(of, chosen, longer_side);
    if (!std::ranges::all_of(views, &swept_view::has_known_range))
        narrow_ranges(views, prepared(of, chosen, coarse_side));
    for_each_in_parallel(views.size(), [&](std::size_t v) { sweep_view(views, v); });
    std::vector<colored_point> points;
    for (swept_view& view : views)
        for (std::size_t i = 0; i < view.inverse.size(); ++i) {
            if (view.inverse[i] == 0 || view.is_taken[i]) continue;
            const glm::dvec3 point = view.point(i);
            bool agrees = false;
            for (const std::size_t other : view.others)
                if (const auto pixel = pixel_that_agrees(views[other], point)) {
                    views[other].is_taken[*pixel] = true;
                    agrees = true;
                }
            if (agrees) points.push_back({point, view.photo.color[i]});
        }
    return points;
}

}  // namespace gs::stereo
