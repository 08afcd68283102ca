// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "render/project/projection.hpp"
#include "scene/camera.hpp"

namespace {

constexpr double degree = std::numbers::pi / 180;

gs::camera fisheye_camera() {
    gs::camera c{800, 600, 260, 250, 390, 310};
    c.rotation = glm::mat3_cast(glm::normalize(glm::dquat(1, 0.2, -0.4, 0.3)));
    c.translation = {0.3, -0.1, 0.7};
    c.fisheye = gs::fisheye({0.04, -0.012, 0.003, -0.0004});
    return c;
}

/// A point in camera space at this distance from the axis.
glm::dvec3 place_at(double angle, double around, double distance) {
    return distance * glm::dvec3(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
                                 std::cos(angle));
}

/// Angles on the axis, next to it, where one formula follows on another, and beyond the plane of the camera.
const std::vector<double> angles = {0,           1e-9,          1e-5,         1e-3,
                                    0.2,         41.4 * degree, 0.7227342478, 41.5 * degree,
                                    89 * degree, 90 * degree,   91 * degree,  115 * degree};

struct lens_case {
    gs::camera camera;
    std::vector<double> angles;
};
/// That lens, and one that bends nothing, which sees farther.
std::vector<lens_case> lens_cases() {
    gs::camera wide = fisheye_camera();
    wide.fisheye = gs::fisheye({0, 0, 0, 0});
    return {{fisheye_camera(), angles}, {wide, {150 * degree, 170 * degree}}};
}

template <class Real>
using projection = gs::raster::projection_of<Real, gs::effect_set{.lens = gs::lens_model::fisheye}>;

}  // namespace

TEST_CASE("fisheye: angle and radius are each other's inverse, up to where the lens ends") {
    const gs::fisheye plain({0, 0, 0, 0});
    CHECK(plain.end() == gs::fisheye::widest);
    CHECK(plain.radius(1.25) == 1.25);
    const gs::fisheye turns_back({-0.1, 0, 0, 0});  // t - 0.1 t^3 grows up to sqrt(1 / 0.3)
    CHECK(turns_back.end() == doctest::Approx(std::sqrt(1 / 0.3)).epsilon(1e-12));
    CHECK(turns_back.angle(100) == turns_back.end());
    for (const gs::fisheye& lens : {plain, turns_back, *fisheye_camera().fisheye})
        for (const double angle : {0.0, 1e-6, 0.1, 0.7, 1.5})
            CHECK(lens.angle(lens.radius(angle)) == doctest::Approx(angle).epsilon(1e-12));
}

TEST_CASE("fisheye: a ray through where a point is seen meets it") {
    for (const auto& [c, angles] : lens_cases())
        for (const double angle : angles) {
            const glm::dvec3 point = glm::transpose(c.rotation) * (place_at(angle, 0.8, 2.5) - c.translation);
            const auto seen = c.see(point);
            REQUIRE(seen);
            CHECK(seen->depth == doctest::Approx(2.5));
            const glm::dvec3 to = glm::normalize(point - c.center()), ray = c.ray(seen->x, seen->y);
            CHECK(glm::length(ray - to) < 1e-9);
        }
    const gs::camera c = fisheye_camera();
    CHECK_FALSE(c.see(c.center() - glm::transpose(c.rotation) * glm::dvec3(0, 0, 1)));  // behind it
}

TEST_CASE("fisheye: without bends a small image is a pinhole camera's") {
    gs::camera bent = fisheye_camera(), straight = bent;
    bent.fisheye = gs::fisheye({0, 0, 0, 0});
    straight.fisheye.reset();
    const glm::dvec3 point = glm::transpose(bent.rotation) * (glm::dvec3(0.01, -0.02, 3) - bent.translation);
    const auto a = bent.see(point), b = straight.see(point);
    CHECK(a->x == doctest::Approx(b->x).epsilon(1e-6));
    CHECK(a->y == doctest::Approx(b->y).epsilon(1e-6));
}

TEST_CASE("angle over sine: value and derivatives against those of long double") {
    for (const double v : {0.0, 1e-12, 1e-6, 0.01, 0.1, 0.2499999}) {
        // By the differential equation (1 - u^2) f' = u f - 1, from v = 1 - u; on the axis 1, -1/3 and 4/15.
        const long double u = 1 - static_cast<long double>(v), square = v * (2 - static_cast<long double>(v));
        const gs::raster::angle_by_sine<double> f(v);
        if (v < 1e-3) {
            const long double d = v;
            CHECK(f.value == doctest::Approx(static_cast<double>(1 + d / 3 + 2 * d * d / 15)).epsilon(1e-9));
            CHECK(f.first == doctest::Approx(static_cast<double>(-1 / 3.0L - 4 * d / 15)).epsilon(1e-9));
            CHECK(f.second == doctest::Approx(static_cast<double>(4 / 15.0L + 12 * d / 35)).epsilon(1e-9));
            continue;
        }
        const long double value = std::acos(u) / std::sqrt(square), first = (u * value - 1) / square;
        CHECK(f.value == doctest::Approx(static_cast<double>(value)).epsilon(1e-14));
        CHECK(f.first == doctest::Approx(static_cast<double>(first)).epsilon(1e-13));
        CHECK(f.second ==
              doctest::Approx(static_cast<double>((3 * u * first + value) / square)).epsilon(1e-11));
    }
}

TEST_CASE("fisheye: kernels see what the camera sees, with the derivatives of central differences") {
    for (const lens_case& of : lens_cases()) {
        const gs::camera& c = of.camera;
        const auto camera = gs::raster::for_device<double>(c);
        std::mt19937 random(1);
        std::normal_distribution<double> normal;
        const auto some = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
        const auto at = [&](const glm::dvec3& point) {
            return projection<double>(c.rotation * point + c.translation, camera);
        };
        for (const double angle : of.angles)
            for (const double around : {0.0, 0.8, 4.0}) {
                CAPTURE(angle);
                CAPTURE(around);
                const glm::dvec3 point =
                    glm::transpose(c.rotation) * (place_at(angle, around, 2.5) - c.translation);
                const auto p = at(point);
                const auto seen = c.see(point);
                CHECK(p.x == doctest::Approx(seen->x).epsilon(1e-12));
                CHECK(p.y == doctest::Approx(seen->y).epsilon(1e-12));
                CHECK(projection<double>::depth(c.rotation * point + c.translation) == doctest::Approx(2.5));

                const glm::dvec2 by_center(normal(random), normal(random));
                const glm::dvec3 by_px = some(), by_py = some();
                const glm::dvec3 gradient = p.position_gradient(by_center, by_px, by_py, camera);
                constexpr double step = 1e-5;
                for (int k = 0; k < 3; ++k) {
                    glm::dvec3 aside(0);
                    aside[k] = step;
                    const auto more = at(point + aside), less = at(point - aside);
                    CHECK(p.px[k] == doctest::Approx((more.x - less.x) / (2 * step)).epsilon(1e-6));
                    CHECK(p.py[k] == doctest::Approx((more.y - less.y) / (2 * step)).epsilon(1e-6));
                    const double change = glm::dot(by_center, glm::dvec2(more.x - less.x, more.y - less.y)) +
                                          glm::dot(by_px, more.px - less.px) +
                                          glm::dot(by_py, more.py - less.py);
                    CHECK(gradient[k] == doctest::Approx(change / (2 * step)).epsilon(1e-6).scale(100));
                }
            }
    }
}

TEST_CASE("fisheye: float is near double, on the axis as well") {
    for (const lens_case& of : lens_cases()) {
        const gs::camera& c = of.camera;
        const auto wide = gs::raster::for_device<double>(c);
        const auto narrow = gs::raster::for_device<float>(c);
        for (const double angle : of.angles)
            for (const double around : {0.3, 2.0}) {
                CAPTURE(angle);
                const glm::vec3 at(place_at(angle, around, 2.5));
                const projection<double> exact(glm::dvec3(at), wide);
                const projection<float> rounded(at, narrow);
                const double size = glm::length(exact.px) + glm::length(exact.py);
                CHECK(std::abs(rounded.x - exact.x) < 2e-4);
                CHECK(std::abs(rounded.y - exact.y) < 2e-4);
                CHECK(glm::length(glm::dvec3(rounded.px) - exact.px) < 1e-5 * size);
                CHECK(glm::length(glm::dvec3(rounded.py) - exact.py) < 1e-5 * size);
                const glm::vec3 a(0.3, -0.5, 0.8), b(-0.7, 0.1, 0.4);
                const glm::dvec3 g = exact.position_gradient({0.2, 0.3}, a, b, wide);
                const glm::dvec3 h(rounded.position_gradient({0.2f, 0.3f}, a, b, narrow));
                CHECK(glm::length(g - h) < 1e-4 * size);
            }
    }
}

TEST_CASE("fisheye: what is too near or beyond the image's cone is not drawn") {
    const gs::camera c = fisheye_camera();
    const auto camera = gs::raster::for_device<double>(c);
    const auto is_drawn = [&](double angle, double distance) {
        return projection<double>::is_drawn(place_at(angle, 1, distance), camera);
    };
    CHECK(is_drawn(0, 0.16));
    CHECK_FALSE(is_drawn(0, 0.14));
    // The farthest corner of the image and 15 % on every side: 1.9 and 1.6 focal lengths off.
    const double cone = c.fisheye->angle(std::hypot((410 + 120) / 260.0, (310 + 90) / 250.0));
    CHECK(is_drawn(cone - 0.01, 2));
    CHECK_FALSE(is_drawn(cone + 0.01, 2));
    const auto narrow = gs::raster::for_device<float>(c);
    const float infinite = std::numeric_limits<float>::infinity();
    for (const glm::vec3& at : {glm::vec3(0), glm::vec3(0, 0, -1), glm::vec3(infinite, 0, 0)})
        CHECK_FALSE(projection<float>::is_drawn(at, narrow));
    gs::camera at_origin = c;
    at_origin.rotation = glm::dmat3(1);
    at_origin.translation = {0, 0, 0};
    CHECK_FALSE(at_origin.see({0, 0, 0}));
}

TEST_CASE("fisheye: kernels' rays are the camera's") {
    gs::camera c = fisheye_camera();
    c.rotation = glm::dmat3(1);
    const auto narrow = gs::raster::for_device<float>(c);
    for (const double x : {390.0, 390.001, 391.0, 17.0, 800.0})
        for (const double y : {310.0, 200.0, 599.0}) {
            const glm::vec2 place((x - c.cx) / c.fx, (y - c.cy) / c.fy);
            const glm::dvec3 ray(gs::raster::fisheye_ray(place, narrow));
            CHECK(glm::length(glm::normalize(ray) - c.ray(x, y)) < 2e-6);
        }
}
