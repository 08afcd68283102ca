// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "initialize.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>
#include <utility>

#include "../model/aosoa.hpp"
#include "../model/morton_order.hpp"
#include "../model/spherical_harmonics.hpp"
#include "neighbor_distances.hpp"

namespace gs {
namespace {

constexpr double initial_opacity = 0.1;
constexpr std::size_t neighbors = 3;
/// The smallest squared scale in internal coordinates, for points that coincide.
constexpr double least_squared_distance = 1e-7;
/// Half the side of the box around the objects of NeRF-synthetic scenes, relative to the distance
/// of their cameras.
constexpr double half_side_of_objects = 1.3 / 4.0311288;

/// Returns a uniform number in [0, 1). The distributions of the standard library would give
/// different results on different implementations.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Keeps at most `most` random points, in their order. All subsets are equally likely.
void keep_at_random(std::vector<colored_point>& points, std::size_t most, std::uint64_t seed) {
    if (points.size() <= most) return;
    std::mt19937_64 random(seed);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = 0; i < most; ++i) {
        const double left = static_cast<double>(order.size() - i);
        std::swap(order[i], order[i + static_cast<std::size_t>(uniform(random) * left)]);
    }
    order.resize(most);
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < most; ++i) points[i] = points[order[i]];
    points.resize(most);
}

/// Orders points along a Morton curve, so that a warp has Gaussians which the same views show. The curve
/// is cut into pieces in random order, so that ranks, which own consecutive Gaussians, all own some
/// that a view shows.
void sort_by_place(std::vector<colored_point>& points) {
    constexpr std::size_t piece = 4 * block_length;
    std::vector<float> positions;
    positions.reserve(3 * points.size());
    for (const colored_point& p : points)
        for (glm::length_t axis = 0; axis < 3; ++axis)
            positions.push_back(static_cast<float>(p.position[axis]));
    std::vector<std::uint32_t> order = morton_order(positions);
    std::mt19937_64 random;
    for (std::size_t n = points.size() / piece; n > 1; --n) {
        const auto other = static_cast<std::size_t>(uniform(random) * static_cast<double>(n));
        if (other == n - 1) continue;
        std::swap_ranges(order.begin() + static_cast<std::ptrdiff_t>((n - 1) * piece),
                         order.begin() + static_cast<std::ptrdiff_t>(n * piece),
                         order.begin() + static_cast<std::ptrdiff_t>(other * piece));
    }
    std::vector<colored_point> sorted;
    sorted.reserve(points.size());
    for (const std::uint32_t i : order) sorted.push_back(points[i]);
    points = std::move(sorted);
}

std::pair<glm::dvec3, double> box_looked_at(const scene& s) {
    const auto object = s.object_centered ? s.looked_at() : std::nullopt;
    if (object) {
        std::vector<double> distances;
        for (const view& v : s.train) distances.push_back(glm::distance(*object, v.camera.center()));
        const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
        std::ranges::nth_element(distances, median);
        return {*object, half_side_of_objects * *median};
    }
    glm::dvec3 sum{0};
    for (const view& v : s.train) sum += v.camera.center();
    return {sum / static_cast<double>(s.train.size()), s.extent()};
}

}  // namespace

gaussians from_points(std::vector<colored_point> points, int sh_degree, std::size_t most,
                      std::uint64_t seed) {
    keep_at_random(points, most, seed);
    sort_by_place(points);
    const std::vector<double> squared_distance = neighbor_distances(points, neighbors);
    const std::size_t count = points.size();

    gaussians model;
    model.sh_degree = sh_degree;
    model.mean.resize(3 * count);
    model.log_scale.resize(3 * count);
    model.sh_constant.resize(3 * count);
    model.quaternion.assign(4 * count, 0.0F);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < count; ++i) {
        const double squared = std::max(squared_distance[i], least_squared_distance);
        const auto log_scale = static_cast<float>(0.5 * std::log(squared));
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<glm::length_t>(k);
            model.mean[3 * i + k] = static_cast<float>(points[i].position[axis]);
            model.log_scale[3 * i + k] = log_scale;
            model.sh_constant[3 * i + k] = sh_from_color(static_cast<float>(points[i].color[axis]) / 255.0F);
        }
        model.quaternion[4 * i] = 1;
    }
    model.opacity.assign(count, static_cast<float>(std::log(initial_opacity / (1 - initial_opacity))));
    model.sh_rest.assign(count * static_cast<std::size_t>(model.rest_width()), 0.0F);
    return model;
}

std::vector<colored_point> random_points(const scene& scene, std::size_t count, std::uint64_t seed) {
    const auto [center, half_side] = box_looked_at(scene);
    std::mt19937_64 random(seed);
    std::vector<colored_point> points(count);
    for (colored_point& p : points) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            p.position[axis] = center[axis] + half_side * (2 * uniform(random) - 1);
            p.color[axis] = static_cast<std::uint8_t>(256 * uniform(random));
        }
    }
    return points;
}

}  // namespace gs
