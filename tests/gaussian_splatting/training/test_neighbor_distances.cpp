// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "../../../examples/gaussian_splatting/core/random.hpp"
#include "../../../examples/gaussian_splatting/training/neighbor_distances.hpp"

namespace {

/// Returns the mean squared distance of a point to its 3 nearest others, by comparing it with all.
double by_comparison(const std::vector<gs::colored_point>& points, std::size_t of) {
    std::array<double, 3> nearest;
    nearest.fill(std::numeric_limits<double>::max());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 apart = points[i].position - points[of].position;
        const double squared = glm::dot(apart, apart);
        if (i == of || squared >= nearest[2]) continue;
        nearest[2] = squared;
        std::sort(nearest.begin(), nearest.end());
    }
    return (nearest[0] + nearest[1] + nearest[2]) / 3;
}

}  // namespace

TEST_CASE("neighbor distances: many points, in clusters, give what comparing all of them gives") {
    constexpr std::size_t count = 210000, clusters = 50;
    gs::train::counter_random random(1, 0, 0);
    const auto uniform = [&] { return static_cast<double>(random.below(1U << 30)) * 0x1p-30; };
    std::vector<glm::dvec3> centers(clusters);
    for (auto& c : centers) c = {uniform(), uniform(), 0.01 * uniform()};
    std::vector<gs::colored_point> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double size = i % 3 == 0 ? 1 : 0.01;
        points[i].position = size * glm::dvec3(uniform(), uniform(), uniform()) + centers[i % clusters];
    }
    points[7].position = {50, 50, 50};  // its neighbors are in other parts

    const std::vector<double> found = gs::neighbor_distances(points, 3);
    for (std::size_t i = 7; i < count; i += 1500) {
        CAPTURE(i);
        REQUIRE(found[i] == doctest::Approx(by_comparison(points, i)).epsilon(1e-12));
    }
}
