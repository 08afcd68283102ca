// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_distance.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>

#include "../../core/parallel.hpp"

namespace gs::features {
namespace {

constexpr std::size_t most_squares = 4000;
constexpr std::size_t least_comparisons = 100;
constexpr double same_color = 0.04;  ///< root mean square over channels
/// Distances in extents. They are larger than the distances of the cameras from their mean.
constexpr std::array distances{10.0, 7.0, 5.0, 3.5, 2.5, 1.7};

/// A predicted square. It was seen from `eye` in the direction `ray`.
struct sighting {
    std::size_t view;
    glm::dvec3 eye, ray, color;
};

std::vector<sighting> sightings(const scene& of, const std::vector<photo_cells>& cells, const sky_fit& fit,
                                const std::vector<double>& gain) {
    std::size_t all = 0;
    for (const auto& photo : fit.predicted) all += photo.size();
    const std::size_t step = all / most_squares + 1;
    std::vector<sighting> found;
    std::size_t number = 0;
    for (std::size_t v = 0; v < fit.predicted.size(); ++v)
        for (const std::uint32_t i : fit.predicted[v]) {
            if (number++ % step != 0) continue;
            const camera& c = of.train[v].camera;
            found.push_back(
                {v, c.center(), cells[v].ray(c, i), gain[v] * glm::dvec3(cells[v].cells[i].color)});
        }
    return found;
}

/// Returns the factors that even out the brightness of photos.
std::vector<double> gains(const scene& of, const std::vector<double>& brighter) {
    std::vector<double> gain(of.train.size(), 1.0);
    for (std::size_t v = 0; v < brighter.size(); ++v) gain[v] = std::exp2(-brighter[v]);
    return gain;
}

/// Returns the place at which the ray of a sighting leaves a sphere. Precondition: its eye is inside.
glm::dvec3 place_on_sphere(const sighting& s, const glm::dvec3& center, double radius) {
    const glm::dvec3 from = s.eye - center;
    const double along = glm::dot(from, s.ray);
    return s.eye + (std::sqrt(along * along - glm::dot(from, from) + radius * radius) - along) * s.ray;
}

const photo_cell* cell_at(const photo_cells& photo, const camera& c, const glm::dvec3& position) {
    const auto p = c.see(position);
    if (!p || !(p->x >= 0 && p->y >= 0 && p->x < photo.side * photo.across && p->y < photo.side * photo.down))
        return nullptr;
    const int column = static_cast<int>(p->x) / photo.side, row = static_cast<int>(p->y) / photo.side;
    return &photo.cells[static_cast<std::size_t>(row * photo.across + column)];
}

/// Returns whether a photo shows a sighting at this position, or nothing if it cannot tell.
std::optional<bool> shows(const photo_cells& photo, const camera& c, double gain, const sighting& s,
                          const glm::dvec3& position) {
    const photo_cell* cell = cell_at(photo, c, position);
    if (cell == nullptr || cell->shows == photo_cell::content::transparent) return std::nullopt;
    const glm::dvec3 off = gain * glm::dvec3(cell->color) - s.color;
    if (cell->shows == photo_cell::content::smooth && glm::dot(off, off) < 3 * same_color * same_color)
        return true;
    return cell->near_points ? std::nullopt : std::optional(false);
}

struct comparisons {
    std::size_t all = 0, near_only = 0, far_only = 0;

    void add(const comparisons& other) {
        all += other.all;
        near_only += other.near_only;
        far_only += other.far_only;
    }
};

/// Returns the number of comparisons that match at infinity, with every `step`-th sighting.
std::size_t far_matches(const scene& of, const std::vector<photo_cells>& cells,
                        const std::vector<double>& gain, const std::vector<sighting>& squares,
                        std::size_t step) {
    std::vector<std::size_t> by_view(of.train.size());
    for_each_in_parallel(by_view.size(), [&](std::size_t v) {
        const camera& c = of.train[v].camera;
        for (std::size_t i = 0; i < squares.size(); i += step)
            if (squares[i].view != v &&
                shows(cells[v], c, gain[v], squares[i], c.center() + squares[i].ray).value_or(false))
                ++by_view[v];
    });
    return std::accumulate(by_view.begin(), by_view.end(), std::size_t{0});
}

}  // namespace

double strength_of_falloff(const scene& of, const std::vector<photo_cells>& cells, const sky_fit& fit,
                           const std::vector<double>& brighter) {
    constexpr std::size_t step = 4;
    const std::vector<double> gain = gains(of, brighter);
    double best = 0;
    std::size_t most = 0;
    for (int tenth = 0; tenth <= 8; ++tenth) {
        std::vector<photo_cells> bright = cells;
        const double strength = tenth / 10.0;
        remove_falloff(of, {strength, strength, strength}, bright);
        const std::size_t matches = far_matches(of, bright, gain, sightings(of, bright, fit, gain), step);
        if (matches <= most) continue;
        most = matches;
        best = strength;
    }
    return best;
}

sky_distance measure_distance(const scene& of, const std::vector<photo_cells>& cells, const sky_fit& fit,
                              const std::vector<double>& brighter) {
    const double extent = of.extent();
    glm::dvec3 center(0);
    for (const view& v : of.train) center += v.camera.center() / static_cast<double>(of.train.size());
    const std::vector<double> gain = gains(of, brighter);
    const std::vector<sighting> squares = sightings(of, cells, fit, gain);

    std::vector<std::array<comparisons, distances.size()>> by_view(of.train.size());
    for_each_in_parallel(by_view.size(), [&](std::size_t v) {
        const camera& c = of.train[v].camera;
        const glm::dvec3 eye = c.center();
        for (const sighting& s : squares) {
            const std::optional<bool> far =
                s.view == v ? std::nullopt : shows(cells[v], c, gain[v], s, eye + s.ray);
            if (!far) continue;
            for (std::size_t d = 0; d < distances.size(); ++d) {
                const std::optional<bool> near =
                    shows(cells[v], c, gain[v], s, place_on_sphere(s, center, distances[d] * extent));
                if (!near) continue;
                ++by_view[v][d].all;
                if (*near && !*far) ++by_view[v][d].near_only;
                if (*far && !*near) ++by_view[v][d].far_only;
            }
        }
    });

    sky_distance found;
    for (std::size_t d = 0; d < distances.size(); ++d) {
        comparisons sum;
        for (const auto& view : by_view) sum.add(view[d]);
        if (sum.all < least_comparisons) continue;
        const double near_only = static_cast<double>(sum.near_only) / static_cast<double>(sum.all);
        const double far_only = static_cast<double>(sum.far_only) / static_cast<double>(sum.all);
        if (found.distance == 0 || near_only - far_only > found.near_only - found.far_only)
            found = {distances[d], near_only, far_only};
    }
    return found;
}

}  // namespace gs::features
