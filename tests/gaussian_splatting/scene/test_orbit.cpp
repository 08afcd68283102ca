// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/look_at.hpp"
#include "scene/orbit.hpp"

namespace {

/// Cameras on a circle of this radius at this height, which look at a point, with z up.
gs::scene circle(int cameras, const glm::dvec3& center, double radius, double height) {
    gs::scene scene;
    for (int i = 0; i < cameras; ++i) {
        const double angle = 2 * std::numbers::pi * i / cameras;
        const glm::dvec3 from =
            center + glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), height);
        gs::view view;
        view.camera = gs::look_at(from, center, {0, 0, 1}, 64, 80);
        scene.train.push_back(view);
    }
    return scene;
}

}  // namespace

TEST_CASE("orbit: it keeps the center, height, distance and up vector of the cameras") {
    const gs::orbit o = gs::orbit_of(circle(12, {1, 2, 3}, 5, 2));
    CHECK(glm::length(o.center - glm::dvec3(1, 2, 3)) < 1e-6);
    CHECK(glm::length(o.up - glm::dvec3(0, 0, 1)) < 1e-6);
    CHECK(o.radius == doctest::Approx(5));
    CHECK(o.height == doctest::Approx(2));
    CHECK(o.field_of_view == doctest::Approx(2 * std::atan(0.4)));
    CHECK(std::abs(glm::dot(o.up, o.ahead)) < 1e-9);
}

TEST_CASE("orbit: its cameras look at the center, in images of any shape") {
    const gs::orbit o = gs::orbit_of(circle(5, {0, 0, 0}, 4, 1));
    for (const double turn : {0.0, 0.3, 0.9}) {
        const gs::camera c = o.camera_at(turn, 60, 40);
        const auto center = c.see(o.center), above = c.see(o.center + 0.1 * o.up);
        CHECK(center->x == doctest::Approx(30));
        CHECK(center->y == doctest::Approx(20));
        CHECK(center->depth == doctest::Approx(std::sqrt(17.0)));
        CHECK(above->x == doctest::Approx(30));
        CHECK(above->y < 20);
        CHECK(c.fy == doctest::Approx(20 / std::tan(o.field_of_view / 2)));
    }
    CHECK(glm::length(o.camera_at(0, 8, 8).center() - o.camera_at(1, 8, 8).center()) < 1e-9);
}

TEST_CASE("orbit: a single camera, and cameras without a common up vector, have one") {
    gs::scene one = circle(1, {0, 0, 0}, 3, 0);
    CHECK(gs::orbit_of(one).radius == doctest::Approx(3));
    gs::scene opposed = circle(1, {0, 0, 0}, 3, 0);
    opposed.train.push_back(opposed.train.front());
    opposed.train[1].camera = gs::look_at({0, 3, 0}, {0, 0, 0}, {0, 0, -1}, 64, 80);
    const gs::orbit o = gs::orbit_of(opposed);
    CHECK(glm::length(o.up) == doctest::Approx(1));
    CHECK(std::isfinite(glm::length(o.camera_at(0.2, 8, 8).translation)));
}
