// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <vector>
#include <warpagg/warp/simd.hpp>

#include "../training/engines.hpp"
#include "model/gaussians.hpp"
#include "render/project/projection.hpp"
#include "scene/camera.hpp"

namespace {

constexpr double pi = std::numbers::pi;

template <class Real>
using projection = gs::raster::projection_of<Real, gs::effect_set{.lens = gs::lens_model::panorama}>;

/// A point in camera space.
glm::dvec3 place_at(double longitude, double latitude, double distance) {
    return distance * glm::dvec3(std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                                 std::cos(latitude) * std::cos(longitude));
}

gs::camera turned_panorama() {
    gs::camera c = gs::camera::panorama(800, 400);
    c.rotation = glm::mat3_cast(glm::normalize(glm::dquat(1, 0.2, -0.4, 0.3)));
    c.translation = {0.3, -0.1, 0.7};
    return c;
}

/// Directions forward, to all sides, at the seam and near the poles.
const std::vector<glm::dvec2> directions{
    {0, 0},         {1e-9, -1e-9},        {0.8, 0.3},           {-2, 0.9},
    {pi / 4, -1.2}, {pi / 2, 0},          {-3 * pi / 4, 0.5},   {pi - 1e-3, -0.4},
    {1e-3 - pi, 1}, {2.5, pi / 2 - 1e-2}, {-0.7, 1e-3 - pi / 2}};

/// Gaussians of many sizes in all directions, also at the poles and at the seam.
gs::gaussians crowd_around(std::size_t count) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    gs::gaussians model;
    model.sh_degree = 0;
    const auto put = [](std::vector<float>& to, double x) { to.push_back(static_cast<float>(x)); };
    for (std::size_t i = 0; i < count; ++i) {
        const double latitude = i % 5 == 0 ? pi / 2 - 0.1 * normal(random) : 0.7 * normal(random);
        const glm::dvec3 at = place_at(i % 3 == 0 ? pi + 0.1 * normal(random) : 3 * normal(random), latitude,
                                       2 + std::abs(normal(random)));
        for (int k = 0; k < 3; ++k) put(model.mean, at[k]);
        for (int k = 0; k < 3; ++k) put(model.log_scale, -2.5 + 0.8 * normal(random));
        for (int k = 0; k < 4; ++k) put(model.quaternion, normal(random));
        put(model.opacity, normal(random));
        for (int k = 0; k < 3; ++k) put(model.sh_constant, normal(random));
    }
    return model;
}

std::vector<float> render(gs::train::engine& engine, const gs::camera& camera) {
    return engine.render(camera, {0.1f, 0.3f, 0.5f}, {});
}

}  // namespace

TEST_CASE("panorama: directions and pixels as documented") {
    const gs::camera c = gs::camera::panorama(800, 400);
    const auto shows = [&](const glm::dvec3& point, double x, double y) {
        const auto seen = c.see(point);
        REQUIRE(seen);
        CHECK(seen->x == doctest::Approx(x));
        CHECK(seen->y == doctest::Approx(y));
        CHECK(seen->depth == doctest::Approx(glm::length(point)));
    };
    shows({0, 0, 2}, 400, 200);   // forward
    shows({2, 0, 0}, 600, 200);   // to the right
    shows({-2, 0, 0}, 200, 200);  // to the left
    shows({0, 2, 2}, 400, 300);   // half way down
    shows({1e-9, 0, -2}, 800, 200);
    shows({-1e-9, 0, -2}, 0, 200);
    shows({0, -2, 1e-9}, 400, 0);
    CHECK_FALSE(c.see({0, 0, 0}));
    const gs::camera half = c.resized(401, 199);
    CHECK(half.is_panorama);
    CHECK(half.see({1e-9, 0, -2})->x == doctest::Approx(401));
    CHECK(half.see({0, 2, 1e-9})->y == doctest::Approx(199));
}

TEST_CASE("panorama: a ray through where a point is seen meets it") {
    const gs::camera c = turned_panorama();
    for (const glm::dvec2& direction : directions) {
        const glm::dvec3 point =
            glm::transpose(c.rotation) * (place_at(direction.x, direction.y, 2.5) - c.translation);
        const auto seen = c.see(point);
        REQUIRE(seen);
        CHECK(glm::length(c.ray(seen->x, seen->y) - glm::normalize(point - c.center())) < 1e-9);
    }
}

TEST_CASE("panorama: kernels see what the camera sees, with the derivatives of central differences") {
    const gs::camera c = turned_panorama();
    const auto camera = gs::raster::for_device<double>(c);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto some = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
    const auto at = [&](const glm::dvec3& point) {
        return projection<double>(c.rotation * point + c.translation, camera);
    };
    for (const glm::dvec2& direction : directions) {
        CAPTURE(direction.x);
        CAPTURE(direction.y);
        const glm::dvec3 point =
            glm::transpose(c.rotation) * (place_at(direction.x, direction.y, 2.5) - c.translation);
        const auto p = at(point);
        const auto seen = c.see(point);
        CHECK(p.x == doctest::Approx(seen->x).epsilon(1e-12));
        CHECK(p.y == doctest::Approx(seen->y).epsilon(1e-12));
        CHECK(projection<double>::depth(c.rotation * point + c.translation) == doctest::Approx(2.5));

        const glm::dvec2 by_center(normal(random), normal(random));
        const glm::dvec3 by_px = some(), by_py = some();
        const glm::dvec3 gradient = p.position_gradient(by_center, by_px, by_py, camera);
        // Near a pole, derivatives change within the distance to it.
        const double level = std::cos(direction.y), step = 1e-5 * level;
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 aside(0);
            aside[k] = step;
            const auto more = at(point + aside), less = at(point - aside);
            CHECK(p.px[k] == doctest::Approx((more.x - less.x) / (2 * step)).epsilon(1e-6).scale(1 / level));
            CHECK(p.py[k] == doctest::Approx((more.y - less.y) / (2 * step)).epsilon(1e-6));
            const double change = glm::dot(by_center, glm::dvec2(more.x - less.x, more.y - less.y)) +
                                  glm::dot(by_px, more.px - less.px) + glm::dot(by_py, more.py - less.py);
            CHECK(gradient[k] ==
                  doctest::Approx(change / (2 * step)).epsilon(1e-6).scale(100 / (level * level)));
        }
        const auto inverse = [](const glm::dvec3& in_camera) { return 1 / glm::length(in_camera); };
        const glm::dvec3 by_depth = p.inverse_depth_gradient(1, camera);
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 aside(0);
            aside[k] = 1e-5;
            const double more = inverse(c.rotation * (point + aside) + c.translation);
            const double less = inverse(c.rotation * (point - aside) + c.translation);
            CHECK(by_depth[k] == doctest::Approx((more - less) / 2e-5).epsilon(1e-6));
        }
    }
}

TEST_CASE("panorama: float is near double, also in SIMD lanes") {
    using lanes = warpagg::simd_value<float, 8>;
    const gs::camera c = turned_panorama();
    const auto wide = gs::raster::for_device<double>(c);
    const auto narrow = gs::raster::for_device<float>(c);
    const auto in_lanes = gs::raster::for_device<lanes>(c);
    for (const glm::dvec2& direction : directions) {
        CAPTURE(direction.x);
        CAPTURE(direction.y);
        const glm::vec3 at(place_at(direction.x, direction.y, 2.5));
        const projection<double> exact(glm::dvec3(at), wide);
        const projection<float> rounded(at, narrow);
        const projection<lanes> lane(glm::vec<3, lanes>(lanes(at.x), lanes(at.y), lanes(at.z)), in_lanes);
        const auto error = [](float got, double expected) {
            return std::abs(static_cast<double>(got) - expected);
        };
        CHECK(error(rounded.x, exact.x) < 2e-4);
        CHECK(error(rounded.y, exact.y) < 2e-4);
        CHECK(error(lane.x[3], exact.x) < 2e-4);
        CHECK(error(lane.y[3], exact.y) < 2e-4);
        const double width = glm::length(exact.px), height = glm::length(exact.py);
        CHECK(glm::length(glm::dvec3(rounded.px) - exact.px) < 1e-5 * width);
        CHECK(glm::length(glm::dvec3(rounded.py) - exact.py) < 1e-5 * height);
        const glm::vec3 a(0.3, -0.5, 0.8), b(-0.7, 0.1, 0.4);
        const glm::dvec3 g = exact.position_gradient({0.2, 0.3}, a, b, wide);
        const glm::dvec3 h(rounded.position_gradient({0.2f, 0.3f}, a, b, narrow));
        CHECK(glm::length(g - h) < 1e-5 * glm::length(g));
    }
}

TEST_CASE("panorama: everything is drawn but what is too near, and the poles are finite") {
    const auto camera = gs::raster::for_device<float>(gs::camera::panorama(64, 32));
    for (const glm::dvec2& direction : directions) {
        const auto is_drawn = [&](double distance) {
            return projection<float>::is_drawn(glm::vec3(place_at(direction.x, direction.y, distance)),
                                               camera);
        };
        CHECK(is_drawn(0.16));
        CHECK_FALSE(is_drawn(0.14));
    }
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (const glm::vec3& at : {glm::vec3(0), glm::vec3(infinite, 0, 0), glm::vec3(0, std::nanf(""), 1)})
        CHECK_FALSE(projection<float>::is_drawn(at, camera));
    const auto all_finite = [](const auto&... vectors) { return (gs::raster::is_finite(vectors) && ...); };
    for (const float y : {-1e18f, -2.0f, 2.0f, 1e18f})
        for (const float x : {0.0f, -0.0f, 1e-30f, -1e-12f}) {
            CAPTURE(x);
            const projection<float> p({x, y, 0}, camera);
            CHECK(all_finite(p.x, p.y, p.px, p.py));
            CHECK(p.y == doctest::Approx(y < 0 ? 0 : 32).epsilon(1e-4));
            CHECK(all_finite(p.position_gradient({1, 1}, {1, 1, 1}, {1, 1, 1}, camera),
                             p.inverse_depth_gradient(1, camera)));
        }
}

TEST_CASE("panorama: kernels' rays are the camera's") {
    const gs::camera c = gs::camera::panorama(400, 200);
    for (const double x : {0.5, 17.0, 200.0, 200.001, 399.5})
        for (const double y : {0.5, 99.0, 100.0, 199.5}) {
            const glm::vec2 place((x - c.cx) / c.fx, (y - c.cy) / c.fy);
            CHECK(glm::length(glm::dvec3(gs::raster::panorama_ray(place)) - c.ray(x, y)) < 2e-6);
        }
}

TEST_CASE("panorama: a turn of the camera about its axis moves the render around the seam") {
    const gs::gaussians model = crowd_around(400);
    for (const auto make : engines()) {
        const auto engine = make();
        engine->set_model(model);
        for (const auto& [width, height] : {std::pair{128, 64}, {100, 50}, {21, 30}, {3, 2}}) {
            const gs::camera ahead = gs::camera::panorama(width, height);
            const std::vector<float> first = render(*engine, ahead);
            const auto column_count = static_cast<std::size_t>(width);
            for (const int columns : {1, width / 3, width / 2}) {
                CAPTURE(width);
                CAPTURE(columns);
                gs::camera c = ahead;
                const double angle = 2 * pi * columns / width;
                c.rotation = glm::mat3_cast(glm::angleAxis(angle, glm::dvec3(0, 1, 0)));
                const std::vector<float> turned = render(*engine, c);
                float most = 0;
                for (std::size_t i = 0; i < first.size(); ++i) {
                    const std::size_t row = i / column_count * column_count, column = i - row;
                    const std::size_t moved = (column + static_cast<std::size_t>(columns)) % column_count;
                    most = std::max(most, std::abs(first[i] - turned[row + moved]));
                }
                CHECK(most < 2e-3f);
                CHECK(most >= 0);
            }
        }
    }
}

TEST_CASE("panorama: a Gaussian on the seam or at a pole") {
    gs::gaussians model;
    model.sh_degree = 0;
    model.log_scale = {-1.5f, -1.5f, -1.5f};
    model.quaternion = {1, 0, 0, 0};
    model.opacity = {3};
    model.sh_constant = {1, 1, 1};
    const gs::camera c = gs::camera::panorama(128, 64);
    for (const auto make : engines()) {
        const auto engine = make();
        const auto pixel = [&](const std::vector<float>& image, int x, int y) {
            return image[static_cast<std::size_t>(y * c.width + x)];
        };
        model.mean = {0, 0, -3};  // behind the camera
        engine->set_model(model);
        const std::vector<float> seam = render(*engine, c);
        CHECK(pixel(seam, 0, 31) > 0.6f);
        CHECK(pixel(seam, 0, 31) == doctest::Approx(pixel(seam, 127, 31)).epsilon(1e-4));
        CHECK(pixel(seam, 64, 31) == 0.1f);
        model.mean = {0, -3, 0};  // above
        engine->set_model(model);
        const std::vector<float> pole = render(*engine, c);
        for (int x = 0; x < c.width; ++x) {
            CHECK(pixel(pole, x, 0) > 0.6f);
            CHECK(pixel(pole, x, 0) == doctest::Approx(pixel(pole, 64, 0)).epsilon(1e-4));
            CHECK(pixel(pole, x, 32) == 0.1f);
        }
    }
}
