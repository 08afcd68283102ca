// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "readers/load_scene.hpp"
#include "scene/look_at.hpp"
#include "stereo/dense_points.hpp"
#include "stereo/plane_sweep.hpp"
#include "training/first_points.hpp"

namespace {

/// A wall at z = 4, 10 wide and high, with irregular spots. Returns its brightness, from 0 to 255.
double spots(double x, double y) {
    double sum = 0;
    for (int k = 1; k <= 4; ++k)
        sum += std::sin(5.3 * k * x + 1.7 * k * k * y + k) * std::cos(4.1 * k * y - 2.3 * k * x + 2 * k) / k;
    return 128 + 50 * sum;
}

/// The photo of the wall by a camera. Exposure multiplies its brightness.
gs::view photo_of_wall(const gs::camera& c, double exposure = 1,
                       const std::function<double(double, double)>& pattern = spots) {
    gs::view v;
    v.camera = c;
    v.pixels.width = c.width;
    v.pixels.height = c.height;
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const glm::dvec3 ray = c.ray(x + 0.5, y + 0.5), from = c.center();
            const glm::dvec3 hit = from + ray * ((4 - from.z) / ray.z);
            const bool shows_wall = ray.z > 0 && std::max(std::abs(hit.x), std::abs(hit.y)) < 5;
            const double value = shows_wall ? exposure * pattern(hit.x, hit.y) : 0;
            const auto byte = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
            v.pixels.rgba.insert(v.pixels.rgba.end(), {byte, byte, byte, 255});
        }
    return v;
}

/// A camera at a place, turned a little, that looks along z.
gs::camera pinhole(double x, double y) {
    gs::camera c{96, 72, 100, 100, 48, 36};
    const double turn = 0.05 * x;
    c.rotation = glm::dmat3(glm::dvec3(std::cos(turn), 0, std::sin(turn)), glm::dvec3(0, 1, 0),
                            glm::dvec3(-std::sin(turn), 0, std::cos(turn)));
    c.translation = -(c.rotation * glm::dvec3(x, y, 0));
    return c;
}

struct quality {
    double found = 0;  ///< share of all pixels with a distance
    double wrong = 0;  ///< share of these whose point is more than 2 % of the distance off the wall
};

quality compare_with_wall(const gs::stereo::small_view& view, const std::vector<float>& inverse) {
    std::size_t found = 0, wrong = 0;
    for (std::size_t i = 0; i < inverse.size(); ++i) {
        if (inverse[i] == 0) continue;
        ++found;
        const glm::dvec3 point =
            view.camera.center() + glm::dvec3(view.ray[i]) / static_cast<double>(inverse[i]);
        if (std::abs(point.z - 4) > 0.02 * glm::distance(point, view.camera.center())) ++wrong;
    }
    return {static_cast<double>(found) / static_cast<double>(inverse.size()),
            static_cast<double>(wrong) / static_cast<double>(std::max<std::size_t>(found, 1))};
}

quality swept(const std::vector<gs::view>& views, int size = 96) {
    std::vector<gs::stereo::small_view> small;
    for (const gs::view& v : views) small.push_back(gs::stereo::reduced(v, size));
    std::vector<const gs::stereo::small_view*> others;
    for (std::size_t i = 1; i < small.size(); ++i) others.push_back(&small[i]);
    return compare_with_wall(small[0], gs::stereo::sweep(small[0], others, {0.05, 1, 80}));
}

gs::scene real_scene() {
    gs::load_options o;
    o.data = "synthetic:spheres,views=12,noise=0.01";
    gs::scene scene = gs::load_scene(o, [](const std::string&) {});
    scene.rendered = false;
    return scene;
}

/// The median distance of the points from the nearest point of the scene.
double distance_from_scene(const std::vector<gs::colored_point>& points, const gs::scene& truth) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); i += points.size() / 200 + 1) {
        double nearest = 1e9;
        for (const gs::colored_point& p : truth.points)
            nearest = std::min(nearest, glm::distance(p.position, points[i].position));
        distances.push_back(nearest);
    }
    std::ranges::sort(distances);
    return distances.at(distances.size() / 2);
}

}  // namespace

TEST_CASE("stereo: a sweep finds a wall with each lens, whatever the exposures") {
    const std::vector<glm::dvec2> places{{0, 0}, {0.3, 0}, {-0.25, 0.1}, {0, -0.3}};
    for (const auto lens : {gs::lens_model::pinhole, gs::lens_model::fisheye, gs::lens_model::panorama}) {
        CAPTURE(static_cast<int>(lens));
        std::vector<gs::view> views;
        for (const glm::dvec2& place : places) {
            gs::camera c = pinhole(place.x, place.y);
            if (lens == gs::lens_model::fisheye) c.fisheye = gs::fisheye({0.02, 0, 0, 0});
            if (lens == gs::lens_model::panorama) {
                const gs::camera all = gs::camera::panorama(640, 320);
                gs::camera turned = all;
                turned.rotation = c.rotation;
                turned.translation = c.translation;
                c = turned;
            }
            views.push_back(photo_of_wall(c, 1 - 0.5 * std::abs(place.x)));
        }
        const quality q = swept(views, 640);
        const bool is_panorama = lens == gs::lens_model::panorama;
        CHECK(q.found > (is_panorama ? 0.1 : 0.6));   // most of it does not show the wall
        CHECK(q.wrong < (is_panorama ? 0.1 : 0.05));  // a panorama has fewer pixels per degree
    }
}

TEST_CASE("stereo: smooth, repeated and masked surfaces have no distance") {
    const std::vector<gs::camera> cameras{pinhole(0, 0), pinhole(0.3, 0), pinhole(-0.3, 0)};
    const auto views_of = [&](const std::function<double(double, double)>& pattern) {
        std::vector<gs::view> views;
        for (const gs::camera& c : cameras) views.push_back(photo_of_wall(c, 1, pattern));
        return views;
    };
    CHECK(swept(views_of([](double x, double) { return 128 + 0.5 * x; })).found == 0);
    CHECK(swept(views_of([](double x, double) { return 128 + 60 * std::sin(40 * x); })).found < 0.15);
    auto masked = views_of(spots);
    for (std::size_t i = 0; i < masked[0].pixels.rgba.size() / 4; ++i)
        if (i % 96 < 48) masked[0].pixels.mask_pixel(i);
    masked[0].pixels.has_mask = true;
    CHECK(swept(masked).found < 0.5);
    CHECK(swept(masked).found > 0.25);
    CHECK(swept(masked).wrong < 0.05);
}

TEST_CASE("stereo: dense points lie on the surfaces of a scene, also without its points") {
    const gs::scene truth = real_scene();
    const auto near_points = gs::stereo::dense_points(truth);
    gs::scene without = truth;
    without.points.clear();
    const auto blind = gs::stereo::dense_points(without);
    const double spacing = 0.05 * truth.extent();
    REQUIRE(near_points.size() > 1000);
    REQUIRE(blind.size() > 500);
    CHECK(distance_from_scene(near_points, truth) < spacing);
    CHECK(distance_from_scene(blind, truth) < spacing);
}

TEST_CASE("stereo: photos without a partner give no points") {
    gs::scene one = real_scene();
    one.train.resize(1);
    CHECK(gs::stereo::dense_points(one).empty());
    gs::scene same = real_scene();
    for (gs::view& v : same.train) v = same.train[0];
    CHECK(gs::stereo::dense_points(same).empty());
}

TEST_CASE("first points: photos with few points get those of stereo, and other scenes do not") {
    using enum gs::train::point_source;
    const gs::scene few = real_scene();
    const auto first = gs::train::find_first_points(few, automatic, 100000, 1);
    CHECK(first.points.size() > few.points.size());
    CHECK(first.points.size() <= gs::train::enough_points);
    CHECK(first.points[5].position == few.points[5].position);
    CHECK(first.remark.find("stereo finds in the photos, and " + std::to_string(few.points.size())) !=
          std::string::npos);
    CHECK(gs::train::find_first_points(few, given, 100000, 1).points.size() == few.points.size());
    CHECK(gs::train::find_first_points(few, random, 1001, 1).points.size() == 501);
    CHECK(gs::train::find_first_points(few, stereo, 100000, 1).points[0].position != few.points[0].position);

    gs::scene rendered = few;
    rendered.rendered = true;
    CHECK(gs::train::find_first_points(rendered, automatic, 100000, 1).points.size() == few.points.size());
    gs::scene many = few;
    many.points.resize(gs::train::enough_points);
    CHECK(gs::train::find_first_points(many, automatic, 100000, 1).remark.empty());
}

TEST_CASE("first points: sources without points are errors that name the remedy") {
    using enum gs::train::point_source;
    gs::scene lone = real_scene();
    lone.train.resize(1);
    lone.points.clear();
    for (const auto source : {given, stereo}) {
        std::string message;
        try {
            gs::train::find_first_points(lone, source, 1000, 1);
        } catch (const gs::error& e) {
            message = e.what();
        }
        CHECK(message.find("use --init auto") != std::string::npos);
    }
    const auto random_instead = gs::train::find_first_points(lone, automatic, 1000, 1);
    CHECK(random_instead.points.size() == 501);
    CHECK(random_instead.remark.find("hardly any") != std::string::npos);
}
