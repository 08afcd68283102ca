// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "core/median.hpp"
#include "core/random.hpp"
#include "readers/load_scene.hpp"
#include "scene/observations.hpp"
#include "scene/pose_correction.hpp"
#include "scene/pose_fit.hpp"
#include "scene/scene_statistics.hpp"

namespace {

gs::scene loaded(const std::string& parameters) {
    gs::load_options from;
    from.data = "synthetic:" + parameters;
    return gs::load_scene(from, {});
}

/// Returns the root mean square distance, in pixels, between the places of points for two cameras.
double distance_between(const gs::camera& a, const gs::camera& b,
                        const std::vector<gs::colored_point>& points) {
    double sum = 0, count = 0;
    for (const gs::place_in_photo& p : gs::points_in_sight(a, points)) {
        const auto other = b.see(points[p.point].position);
        if (!other || std::abs(other->x - p.x) > a.width / 2.0) continue;  // the border of a panorama
        sum += std::pow(other->x - p.x, 2) + std::pow(other->y - p.y, 2);
        ++count;
    }
    return std::sqrt(sum / count);
}

std::vector<gs::corrected_camera> corrected(const gs::scene& scene) {
    return gs::correct_poses(scene, gs::measure_shifts(scene, scene.train.size()));
}

bool is_same(const gs::camera& a, const gs::camera& b) {
    return a.rotation == b.rotation && a.translation == b.translation;
}

void check_corrected(const std::string& world) {
    CAPTURE(world);
    const std::string name = world + ",noise=0.015";
    const gs::scene truth = loaded(name), given = loaded(name + ",poses=1");
    const std::vector<gs::corrected_camera> found = corrected(given);
    REQUIRE(found.size() == given.train.size());
    std::vector<double> before, after;
    for (std::size_t v = 0; v < found.size(); ++v) {
        if (!found[v].is_aligned) continue;
        before.push_back(distance_between(truth.train[v].camera, given.train[v].camera, truth.points));
        after.push_back(distance_between(truth.train[v].camera, found[v].camera, truth.points));
        CHECK(found[v].camera.width == given.train[v].camera.width);
    }
    CHECK(after.size() >= 0.9 * static_cast<double>(found.size()));
    CHECK(gs::median(after) < 0.2 * gs::median(before));
    CHECK(gs::quantile(after, 0.9) < 0.3 * gs::median(before));
}

}  // namespace

TEST_CASE("pose correction: corrected poses have a fraction of the errors of given ones") {
    check_corrected("spheres,exposure=0.4,vignetting=0.4,views=24");
}

TEST_CASE("long: pose correction: corrected poses have a fraction of the errors in any scene") {
    for (const char* world : {"spheres", "alpha", "spheres,fisheye=60", "spheres,passers=0.15",
                              "spheres,moving=0.3", "spheres,gloss=0.6"})
        check_corrected(world);
}

TEST_CASE("pose correction: photos that are not shifted keep their cameras and observations") {
    for (const char* world : {"alpha,noise=0.03", "spheres,gloss=1", "spheres,poses=0.05"}) {
        CAPTURE(world);
        const gs::scene scene = loaded(world);
        const gs::scene_statistics statistics(scene);
        for (std::size_t v = 0; v < scene.train.size(); ++v)
            CHECK(is_same(statistics.cameras()[v].camera, scene.train[v].camera));
        const gs::observed_points expected = gs::observe_points(scene);
        REQUIRE(statistics.points().size() == expected.size());
        for (std::size_t p = 0; p < expected.size(); ++p)
            CHECK(statistics.points()[p].size() == expected[p].size());
    }
}

TEST_CASE("pose correction: statistics observe points from corrected cameras") {
    const gs::scene scene = loaded("spheres,poses=1");
    const gs::scene_statistics statistics(scene);
    std::size_t count = 0;
    for (const auto& seen : statistics.points())
        for (const gs::observation& o : seen) {
            const auto place = statistics.cameras()[o.view].camera.see(scene.points[o.point].position);
            CHECK(glm::distance(o.place, glm::dvec2(place->x, place->y)) < 1e-9);
            ++count;
        }
    CHECK(count > 1000);
}

TEST_CASE("pose correction: a photo that does not show the colors of points is left out") {
    gs::scene scene = loaded("spheres,poses=1");
    gs::train::counter_random random(3, 0, 0);
    gs::image& wrong = scene.train[7].pixels;
    for (std::size_t i = 0; i < wrong.rgba.size(); ++i)
        if (i % 4 != 3) wrong.rgba[i] = static_cast<std::uint8_t>(20 + random.below(200));
    gs::image& masked = scene.train[9].pixels;
    masked.has_mask = true;
    for (std::size_t i = 0; i < masked.rgba.size() / 4; ++i) masked.mask_pixel(i);
    const std::vector<gs::corrected_camera> found = corrected(scene);
    CHECK(!found[7].is_aligned);
    CHECK(!found[9].is_aligned);
    CHECK(std::ranges::count(found, true, &gs::corrected_camera::is_aligned) >= 44);
}

TEST_CASE("pose correction: few points or none leave photos out") {
    for (const char* world :
         {"spheres,poses=1,points=1", "spheres,poses=1,points=30", "alpha,poses=1,views=1"}) {
        gs::scene scene = loaded(world);
        CHECK(corrected(scene).size() == scene.train.size());
        scene.points.clear();
        for (const gs::corrected_camera& c : corrected(scene)) CHECK(!c.is_aligned);
        const gs::scene_statistics statistics(scene);
        CHECK(is_same(statistics.cameras()[0].camera, scene.train[0].camera));
    }
}

TEST_CASE("pose correction: the number of threads does not matter") {
    const gs::scene scene = loaded("spheres,poses=1,views=12");
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const std::vector<gs::corrected_camera> one = corrected(scene);
    omp_set_num_threads(3);
    const std::vector<gs::corrected_camera> three = corrected(scene);
    omp_set_num_threads(before);
    for (std::size_t v = 0; v < one.size(); ++v) {
        CHECK(one[v].is_aligned == three[v].is_aligned);
        CHECK(is_same(one[v].camera, three[v].camera));
    }
}

TEST_CASE("pose fit: a pose that the photo does not determine stays near the given one") {
    gs::scene scene = loaded("spheres");
    const gs::camera& c = scene.train[0].camera;
    std::vector<std::uint32_t> points;
    for (const gs::place_in_photo& p : gs::points_in_sight(c, scene.points)) points.push_back(p.point);
    const auto fit = [&](const gs::image& photo, const gs::pose_errors& errors) {
        return gs::fit_pose(gs::photo_levels(photo), scene.points, points, c, c, errors, true);
    };
    gs::image gray = scene.train[0].pixels;
    for (std::size_t i = 0; i < gray.rgba.size(); ++i)
        if (i % 4 != 3) gray.rgba[i] = 128;
    CHECK(distance_between(c, fit(gray, {0.01, 0.03}), scene.points) < 0.01);
    CHECK(distance_between(c, fit(scene.train[0].pixels, {0.01, 0.03}), scene.points) < 0.25);
    // The given pose has hardly any error.
    CHECK(distance_between(c, fit(scene.train[5].pixels, {1e-7, 1e-7}), scene.points) < 0.01);
}

TEST_CASE("pose fit: a turn moves points by the given number of pixels") {
    for (const char* world : {"spheres", "spheres,fisheye=120"}) {
        const gs::scene scene = loaded(world);
        const gs::camera &c = scene.train[3].camera, turned = gs::turned_to(c, scene.points, {4, -3});
        CHECK(glm::distance(c.center(), turned.center()) < 1e-9);
        double x = 0, y = 0, count = 0;
        for (const gs::place_in_photo& p : gs::points_in_sight(c, scene.points)) {
            const auto place = turned.see(scene.points[p.point].position);
            if (!place) continue;
            x += place->x - p.x;
            y += place->y - p.y;
            ++count;
        }
        CHECK(x / count == doctest::Approx(4).epsilon(0.1));
        CHECK(y / count == doctest::Approx(-3).epsilon(0.1));
    }
}
