// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "neighbor_distances.hpp"

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <memory>
#include <nanoflann.hpp>
#include <numeric>
#include <span>

namespace gs {
namespace {

/// A point set with the member functions that nanoflann requires.
struct point_set {
    std::span<const glm::dvec3> points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points[i][static_cast<glm::length_t>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // makes nanoflann compute the box
    }
};

struct box {
    glm::dvec3 least, most;

    explicit box(std::span<const glm::dvec3> points) : least(points[0]), most(points[0]) {
        for (const glm::dvec3& p : points) {
            least = glm::min(least, p);
            most = glm::max(most, p);
        }
    }
    double squared_distance(const glm::dvec3& from) const {
        const glm::dvec3 outside = from - glm::clamp(from, least, most);
        return glm::dot(outside, outside);
    }
};

/// A part of the points, which no other part overlaps much, and its search tree. nanoflann builds a tree
/// on one core, so that many trees are built in less time than one of all points.
struct part {
    using metric = nanoflann::L2_Simple_Adaptor<double, point_set>;
    using tree_type = nanoflann::KDTreeSingleIndexAdaptor<metric, point_set, 3, std::uint32_t>;

    explicit part(std::span<const glm::dvec3> positions)
        : points{positions}, bounds(positions), tree(3, points) {}

    point_set points;
    box bounds;
    tree_type tree;
};

using indices = std::span<std::uint32_t>;

/// Divides points into parts of nearly equal size, and sets the indices of the points of each part.
/// Precondition: the number of parts is a power of 2.
void split(const std::vector<glm::dvec3>& points, indices order, std::span<indices> parts) {
    if (parts.size() == 1) {
        parts[0] = order;
        return;
    }
    glm::dvec3 least = points[order[0]], most = least;
    for (const std::uint32_t i : order) {
        least = glm::min(least, points[i]);
        most = glm::max(most, points[i]);
    }
    const glm::dvec3 size = most - least;
    const glm::length_t widest = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = order.size() / 2, half = parts.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
                     [&](auto a, auto b) { return points[a][widest] < points[b][widest]; });
#pragma omp task default(shared)
    split(points, order.first(middle), parts.first(half));
    split(points, order.subspan(middle), parts.subspan(half));
#pragma omp taskwait
}

/// Returns the mean squared distance of a point of a part to its nearest other points.
double mean_squared_distance(const std::vector<std::unique_ptr<part>>& parts, std::size_t own,
                             const glm::dvec3& from, std::size_t others) {
    std::uint32_t index[most_neighbors + 1];
    double squared[most_neighbors + 1] = {};
    nanoflann::KNNResultSet<double, std::uint32_t> nearest(others + 1);
    nearest.init(index, squared);
    parts[own]->tree.findNeighbors(nearest, &from.x, {});
    for (std::size_t k = 0; k < parts.size(); ++k)
        if (k != own && parts[k]->bounds.squared_distance(from) < nearest.worstDist())
            parts[k]->tree.findNeighbors(nearest, &from.x, {});
    // The nearest points include the point itself at distance 0, or are all points at distance 0.
    return std::accumulate(std::begin(squared), std::end(squared), 0.0) / static_cast<double>(others);
}

/// Returns the number of parts: a power of 2.
std::size_t parts_for(std::size_t points) {
    constexpr std::size_t most_points = 100000;
    constexpr std::size_t most_parts = 64;  // each search compares its place with the boxes of all parts
    std::size_t parts = 1;
    while (parts < most_parts && points / parts > most_points) parts *= 2;
    return parts;
}

}  // namespace

std::vector<double> neighbor_distances(const std::vector<colored_point>& points, std::size_t neighbors) {
    std::vector<glm::dvec3> positions(points.size());
    std::ranges::transform(points, positions.begin(), &colored_point::position);
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<indices> of_parts(parts_for(points.size()));
#pragma omp parallel
#pragma omp single
    split(positions, order, of_parts);

    // Points of a part lie side by side, so that searches find them in the cache.
    std::vector<glm::dvec3> ordered(points.size());
#pragma omp parallel for schedule(static)
    for (std::size_t j = 0; j < order.size(); ++j) ordered[j] = positions[order[j]];
    positions = {};

    std::vector<std::unique_ptr<part>> parts(of_parts.size());
#pragma omp parallel for schedule(dynamic)
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto first = static_cast<std::size_t>(of_parts[k].data() - order.data());
        parts[k] =
            std::make_unique<part>(std::span<const glm::dvec3>(ordered).subspan(first, of_parts[k].size()));
    }

    const std::size_t others = std::min(neighbors, points.size() - 1);
    std::vector<double> result(points.size(), 0.0);
    if (others == 0) return result;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const std::span<const glm::dvec3> own = parts[k]->points.points;
#pragma omp parallel for schedule(static)
        for (std::size_t j = 0; j < own.size(); ++j)
            result[of_parts[k][j]] = mean_squared_distance(parts, k, own[j], others);
    }
    return result;
}

}  // namespace gs
