// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>

#include "../../../examples/gaussian_splatting/training/initialize.hpp"

namespace {

constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
const float floor_log_scale = static_cast<float>(0.5 * std::log(1e-7));

std::vector<gs::colored_point> regular_grid(int side, double spacing) {
    std::vector<gs::colored_point> points;
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < side; ++z) {
                points.push_back({spacing * glm::dvec3(x, y, z), {x, y, z}});
            }
        }
    }
    return points;
}

std::vector<gs::colored_point> line(std::initializer_list<double> places) {
    std::vector<gs::colored_point> points;
    for (const double x : places) points.push_back({{x, 0, 0}, {0, 0, 0}});
    return points;
}

gs::scene scene_seen_from(bool object_centered, std::initializer_list<glm::dvec3> centers) {
    gs::scene s;
    s.object_centered = object_centered;
    for (const glm::dvec3& center : centers) {
        gs::view v;
        v.camera.translation = -center;
        s.train.push_back(v);
    }
    return s;
}

/// Twenty cameras about an object, none like another.
gs::scene scene_that_looks_at(const glm::dvec3& object, double distance) {
    gs::scene s;
    s.object_centered = true;
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 z = glm::normalize(glm::dvec3(std::cos(1.0 * i), std::sin(1.7 * i), -1 - 0.1 * i));
        const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0.1 * i), z));
        gs::view v;
        v.camera.rotation = glm::transpose(glm::dmat3(x, glm::cross(z, x), z));
        v.camera.translation = -(v.camera.rotation * (object - distance * z));
        s.train.push_back(v);
    }
    return s;
}

double half_side_about(const glm::dvec3& center, const std::vector<gs::colored_point>& points) {
    double farthest = 0;
    for (const gs::colored_point& p : points)
        for (glm::length_t axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, std::abs(p.position[axis] - center[axis]));
    return farthest;
}

}  // namespace

TEST_CASE("from_points: on a regular grid every Gaussian is as wide as the spacing") {
    const gs::gaussians model = gs::from_points(regular_grid(6, 0.25), 2, all, 0);
    REQUIRE(model.count() == 216);
    REQUIRE(model.log_scale.size() == 3 * 216);
    for (const float s : model.log_scale) CHECK(s == doctest::Approx(std::log(0.25)));
}

TEST_CASE("from_points: the root of the mean of the 3 squared distances, not the mean distance") {
    const gs::gaussians model = gs::from_points(line({0, 1, 3, 10}), 0, all, 0);
    CHECK(model.log_scale[0] == doctest::Approx(0.5 * std::log((1.0 + 9.0 + 100.0) / 3)));
    CHECK(model.log_scale[3] == doctest::Approx(0.5 * std::log((1.0 + 4.0 + 81.0) / 3)));
}

TEST_CASE("from_points: all parameters of a Gaussian") {
    const std::vector<gs::colored_point> points = {{{1, 2, 3}, {0, 128, 255}},
                                                   {{4, 5, 6}, {10, 20, 30}},
                                                   {{7, 8, 9}, {1, 2, 3}},
                                                   {{9, 11, 12}, {4, 5, 6}}};
    for (int degree = 0; degree <= 3; ++degree) {
        const gs::gaussians model = gs::from_points(points, degree, all, 0);
        CHECK(model.sh_degree == degree);
        REQUIRE(model.count() == 4);
        CHECK(std::vector<float>(model.mean.begin(), model.mean.begin() + 6) ==
              std::vector<float>{1, 2, 3, 4, 5, 6});
        CHECK(std::vector<float>(model.quaternion.begin(), model.quaternion.begin() + 8) ==
              std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0});
        CHECK(model.quaternion.size() == 16);
        for (const float o : model.opacity) CHECK(1 / (1 + std::exp(-o)) == doctest::Approx(0.1));
        const float c0 = 0.28209479F;
        CHECK(0.5F + c0 * model.sh_constant[0] == doctest::Approx(0));
        CHECK(0.5F + c0 * model.sh_constant[1] == doctest::Approx(128 / 255.0));
        CHECK(0.5F + c0 * model.sh_constant[2] == doctest::Approx(1));
        CHECK(model.sh_constant.size() == 12);
        CHECK(model.sh_rest == std::vector<float>(4 * static_cast<std::size_t>(model.rest_width()), 0.0F));
    }
}

TEST_CASE("from_points: points that coincide, and too few of them, still get a size") {
    SUBCASE("a lone point") {
        const gs::gaussians model = gs::from_points(line({5}), 3, all, 0);
        REQUIRE(model.count() == 1);
        CHECK(model.log_scale[0] == doctest::Approx(floor_log_scale));
    }
    SUBCASE("two points") {
        for (const float s : gs::from_points(line({0, 2}), 0, all, 0).log_scale) {
            CHECK(s == doctest::Approx(std::log(2.0)));
        }
    }
    SUBCASE("three points") {
        const gs::gaussians model = gs::from_points(line({0, 1, 3}), 0, all, 0);
        CHECK(model.log_scale[0] == doctest::Approx(0.5 * std::log((1.0 + 9.0) / 2)));
    }
    SUBCASE("hundreds at one place") {
        for (const float s : gs::from_points(std::vector<gs::colored_point>(300), 0, all, 0).log_scale) {
            CHECK(s == doctest::Approx(floor_log_scale));
        }
    }
    SUBCASE("a pair of twins and two others") {
        const gs::gaussians model = gs::from_points(line({0, 0, 1, 2}), 0, all, 0);
        CHECK(model.log_scale[0] == doctest::Approx(0.5 * std::log((0.0 + 1.0 + 4.0) / 3)));
        CHECK(model.log_scale[3] == doctest::Approx(model.log_scale[0]));
    }
}

TEST_CASE("from_points: consecutive Gaussians have some of all places") {
    const gs::gaussians model = gs::from_points(regular_grid(40, 1), 0, all, 0);
    const std::size_t part = model.count() / 10;
    for (std::size_t first = 0; first + part <= model.count(); first += part) {
        std::size_t in_octant[8] = {};
        for (std::size_t i = first; i < first + part; ++i) {
            const float* at = &model.mean[3 * i];
            ++in_octant[(at[0] < 20 ? 0 : 1) + (at[1] < 20 ? 0 : 2) + (at[2] < 20 ? 0 : 4)];
        }
        CHECK(std::ranges::count(in_octant, 0u) == 0);
    }
}

TEST_CASE("from_points: neighbors in the order of the Gaussians are close in space") {
    std::vector<gs::colored_point> points = regular_grid(16, 1);
    std::ranges::reverse(points);
    for (std::size_t i = 0; i < points.size(); ++i)
        std::swap(points[i], points[i * 2654435761u % points.size()]);
    const gs::gaussians model = gs::from_points(points, 0, all, 0);
    constexpr std::size_t block = 64;  // a cube of 4 points on each side
    for (std::size_t first = 0; first < model.count(); first += block)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float low = model.mean[3 * first + axis], high = low;
            for (std::size_t i = first; i < first + block; ++i) {
                low = std::min(low, model.mean[3 * i + axis]);
                high = std::max(high, model.mean[3 * i + axis]);
            }
            REQUIRE(high - low <= 4);
        }
}

TEST_CASE("from_points: `most` draws without replacement, by seed, and sizes what it drew") {
    const std::vector<gs::colored_point> points = regular_grid(10, 1);
    const gs::gaussians model = gs::from_points(points, 0, 100, 7);
    REQUIRE(model.count() == 100);

    std::vector<glm::vec3> means;
    for (std::size_t i = 0; i < 100; ++i) {
        means.emplace_back(model.mean[3 * i], model.mean[3 * i + 1], model.mean[3 * i + 2]);
    }
    for (std::size_t i = 0; i < means.size(); ++i) {
        CHECK(std::count(means.begin(), means.end(), means[i]) == 1);
    }
    const double mean_log_scale =
        std::accumulate(model.log_scale.begin(), model.log_scale.end(), 0.0) / (3 * 100.0);
    CHECK(mean_log_scale > std::log(1.3));

    CHECK(gs::from_points(points, 0, 100, 7).mean == model.mean);
    CHECK(gs::from_points(points, 0, 100, 8).mean != model.mean);
    CHECK(gs::from_points(points, 0, 1000, 7).mean == gs::from_points(points, 0, all, 8).mean);
}

TEST_CASE("random_points: the box of a NeRF-synthetic scene") {
    const gs::scene blender = scene_that_looks_at(glm::dvec3(0), 4.0311288);
    const std::vector<gs::colored_point> points = gs::random_points(blender, 5000, 3);
    REQUIRE(points.size() == 5000);
    glm::dvec3 least{0}, greatest{0}, sum{0};
    for (const gs::colored_point& p : points) {
        least = glm::min(least, p.position);
        greatest = glm::max(greatest, p.position);
        sum += p.position;
    }
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(least[axis] >= -1.3000001);
        CHECK(least[axis] < -1.25);
        CHECK(greatest[axis] <= 1.3000001);
        CHECK(greatest[axis] > 1.25);
        CHECK(std::abs(sum[axis] / 5000) < 0.05);
    }
    const auto [dark, bright] = std::minmax_element(
        points.begin(), points.end(), [](const auto& a, const auto& b) { return a.color.r < b.color.r; });
    CHECK(dark->color.r == 0);
    CHECK(bright->color.r == 255);
}

TEST_CASE("random_points: the box follows what the cameras look at") {
    const glm::dvec3 object(5e3, -7e3, 9e3);
    const gs::scene blender = scene_that_looks_at(object, 0.1);
    REQUIRE(blender.looked_at());
    CHECK(glm::distance(*blender.looked_at(), object) < 1e-5);
    CHECK(half_side_about(object, gs::random_points(blender, 1000, 3)) ==
          doctest::Approx(0.1 * 1.3 / 4.0311288).epsilon(0.01));
}

TEST_CASE("random_points: cameras that look one way have the object where the origin is nearest") {
    gs::scene s = scene_seen_from(true, {{0.5, 0.25, -4}});  // looks along z
    SUBCASE("one") { CHECK(glm::distance(s.looked_at().value(), {0.5, 0.25, 0}) < 1e-5); }
    SUBCASE("two, parallel") {
        s = scene_seen_from(true, {{0.5, 0.25, -4}, {-0.5, 0.25, -4}});
        CHECK(glm::distance(s.looked_at().value(), {0, 0.25, 0}) < 1e-5);
    }
    SUBCASE("two, identical") {
        s.train.push_back(s.train[0]);
        CHECK(glm::distance(s.looked_at().value(), {0.5, 0.25, 0}) < 1e-5);
    }
    SUBCASE("in internal coordinates it is the same point") {
        const glm::dvec3 before = s.looked_at().value();
        gs::normalize(s, [](const std::string&) {});
        CHECK(s.train[0].camera.center() == glm::dvec3(0));
        CHECK(glm::distance(s.normalization.to_world(s.looked_at().value()), before) < 1e-5);
    }
    SUBCASE("an object behind the camera is none: the box is about the camera") {
        s = scene_seen_from(true, {{0, 0, 4}});
        CHECK_FALSE(s.looked_at());
        CHECK(half_side_about({0, 0, 4}, gs::random_points(s, 1000, 3)) == doctest::Approx(1).epsilon(0.01));
    }
    SUBCASE("on a tripod they look at nothing together") {
        s = scene_that_looks_at({0, 0, 0}, 4);
        for (gs::view& v : s.train) v.camera.translation = -(v.camera.rotation * glm::dvec3(3, 2, 1));
        CHECK_FALSE(s.looked_at());
    }
}

TEST_CASE("random_points: the box around the cameras of another scene, by seed") {
    const gs::scene colmap = scene_seen_from(false, {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}, {12, 2, 0}});
    const std::vector<gs::colored_point> points = gs::random_points(colmap, 1000, 3);
    const double farthest = half_side_about({11, 1, 0}, points);
    CHECK(farthest <= colmap.extent());
    CHECK(farthest > 0.95 * colmap.extent());
    CHECK(gs::random_points(colmap, 10, 3)[9].position == points[9].position);
    CHECK(gs::random_points(colmap, 10, 4)[9].position != points[9].position);
}
