// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "initialize.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <nanoflann.hpp>
#include <numeric>
#include <random>
#include <utility>

#include "../model/spherical_harmonics.hpp"

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

/// Returns at most `most` random points, in their order. All subsets are equally likely.
std::vector<colored_point> draw(const std::vector<colored_point>& points, std::size_t most,
                                std::uint64_t seed) {
    if (points.size() <= most) return points;
    std::mt19937_64 random(seed);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = 0; i < most; ++i) {
        const double left = static_cast<double>(order.size() - i);
        std::swap(order[i], order[i + static_cast<std::size_t>(uniform(random) * left)]);
    }
    order.resize(most);
    std::sort(order.begin(), order.end());

    std::vector<colored_point> drawn;
    drawn.reserve(most);
    for (const std::size_t i : order) drawn.push_back(points[i]);
    return drawn;
}

/// A point set with the member functions that nanoflann requires.
struct point_set {
    const std::vector<colored_point>& points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points[i].position[static_cast<glm::length_t>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // makes nanoflann compute the box
    }
};

/// Returns for each point the mean squared distance to its nearest other points, of which there are
/// at most `neighbors`.
std::vector<double> neighbor_distances(const std::vector<colored_point>& points) {
    using metric = nanoflann::L2_Simple_Adaptor<double, point_set>;
    using tree_type = nanoflann::KDTreeSingleIndexAdaptor<metric, point_set, 3, std::size_t>;
    const point_set set{points};
    const tree_type tree(3, set);
    const std::size_t others = std::min(neighbors, points.size() - 1);

    std::vector<double> result(points.size(), 0.0);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::size_t index[neighbors + 1];
        double squared[neighbors + 1] = {};
        tree.knnSearch(&points[i].position.x, others + 1, index, squared);
        // The results include the point itself at distance 0, or are all points at distance 0.
        const double sum = std::accumulate(std::begin(squared), std::end(squared), 0.0);
        if (others > 0) result[i] = sum / static_cast<double>(others);
    }
    return result;
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

gaussians from_points(const std::vector<colored_point>& points, int sh_degree, std::size_t most,
                      std::uint64_t seed) {
    const std::vector<colored_point> drawn = draw(points, most, seed);
    const std::vector<double> squared_distance = neighbor_distances(drawn);
    const std::size_t count = drawn.size();

    gaussians model;
    model.sh_degree = sh_degree;
    model.mean.reserve(3 * count);
    model.log_scale.reserve(3 * count);
    model.sh_constant.reserve(3 * count);
    model.quaternion.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const double squared = std::max(squared_distance[i], least_squared_distance);
        const auto log_scale = static_cast<float>(0.5 * std::log(squared));
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            model.mean.push_back(static_cast<float>(drawn[i].position[axis]));
            model.log_scale.push_back(log_scale);
            model.sh_constant.push_back(sh_from_color(static_cast<float>(drawn[i].color[axis]) / 255.0F));
        }
        model.quaternion.insert(model.quaternion.end(), {1, 0, 0, 0});
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
