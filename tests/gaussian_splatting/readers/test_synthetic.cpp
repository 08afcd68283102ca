// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/matrix.hpp>
#include <set>
#include <string>

#include "../../../examples/gaussian_splatting/core/error.hpp"
#include "../../../examples/gaussian_splatting/readers/load_scene.hpp"
#include "../../../examples/gaussian_splatting/readers/synthetic/synthetic.hpp"

namespace {

gs::scene make(const std::string& name, int resolution, bool eval = true, std::uint64_t seed = 0) {
    gs::load_options options;
    options.data = "synthetic:" + name;
    options.resolution = resolution;
    options.eval = eval;
    options.seed = seed;
    return gs::load_scene(options, {});
}

std::string message_of(const std::string& name, int resolution) {
    try {
        make(name, resolution);
    } catch (const gs::error& e) {
        return e.what();
    }
    return "no error";
}

struct pixel_position {
    double x, y;
};

pixel_position project(const gs::camera& c, const glm::dvec3& p) {
    const glm::dvec3 q = c.rotation * p + c.translation;
    return {c.fx * q.x / q.z + c.cx, c.fy * q.y / q.z + c.cy};
}

/// The pixel that a position lies in, or null outside the image.
const std::uint8_t* pixel_at(const gs::image& pixels, pixel_position p) {
    const auto column = static_cast<long>(std::floor(p.x));
    const auto row = static_cast<long>(std::floor(p.y));
    if (column < 0 || row < 0 || column >= pixels.width || row >= pixels.height) return nullptr;
    return &pixels.rgba[static_cast<std::size_t>(4 * (row * pixels.width + column))];
}

/// Whether the pixel or a neighbor is not clear: at a silhouette all samples of one pixel may just miss.
bool covered_around(const gs::image& pixels, pixel_position p) {
    for (const double dx : {0.0, -1.0, 1.0}) {
        for (const double dy : {0.0, -1.0, 1.0}) {
            const std::uint8_t* pixel = pixel_at(pixels, {p.x + dx, p.y + dy});
            if (pixel != nullptr && pixel[3] > 0) return true;
        }
    }
    return false;
}

int largest_difference(const std::uint8_t* pixel, const glm::u8vec3& color) {
    int largest = 0;
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(pixel[c] - color[c]));
    return largest;
}

/// The share of points whose color a view shows at their projection, moved by some pixels.
double share_found(const gs::scene& scene, double move_x, double move_y) {
    int found = 0, looked_up = 0;
    for (const gs::view& v : scene.train) {
        for (const gs::colored_point& point : scene.points) {
            const pixel_position p = project(v.camera, point.position);
            const std::uint8_t* pixel = pixel_at(v.pixels, {p.x + move_x, p.y + move_y});
            if (pixel == nullptr) continue;
            ++looked_up;
            if (largest_difference(pixel, point.color) <= 4) ++found;
        }
    }
    return static_cast<double>(found) / looked_up;
}

bool same_views(const std::vector<gs::view>& a, const std::vector<gs::view>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const gs::view& x, const gs::view& y) {
        return x.name == y.name && x.pixels.rgba == y.pixels.rgba;
    });
}

bool same_points(const gs::scene& a, const gs::scene& b) {
    return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      [](const gs::colored_point& x, const gs::colored_point& y) {
                          return x.position == y.position && x.color == y.color;
                      });
}

}  // namespace

TEST_CASE("synthetic scenes: every listed name makes a scene") {
    const std::vector<std::string> names = gs::synthetic_scene_names();
    CHECK(std::count(names.begin(), names.end(), "spheres") == 1);
    CHECK(std::count(names.begin(), names.end(), "alpha") == 1);
    for (const std::string& name : names) {
        CAPTURE(name);
        const gs::scene scene = make(name, 8);
        CHECK(scene.object_centered);
        CHECK(scene.rendered);
        CHECK(scene.train.size() == 40);
        CHECK(scene.test.size() == 8);
        CHECK(scene.points.size() == 3000);
    }
}

TEST_CASE("synthetic scenes: an unknown name is refused with the known ones") {
    const std::string message = message_of("cubes", 8);
    CHECK(message.find("'cubes'") != std::string::npos);
    for (const std::string& name : gs::synthetic_scene_names()) {
        CHECK(message.find(name) != std::string::npos);
    }
}

TEST_CASE("synthetic scenes: resolution divides the size or is the longer side") {
    struct {
        int resolution, size;
    } const cases[] = {{1, 128}, {2, 64}, {4, 32}, {8, 16}, {3, 3}, {37, 37}};
    for (const auto& expected : cases) {
        CAPTURE(expected.resolution);
        const gs::scene scene = make("spheres", expected.resolution);
        const gs::view& v = scene.test.front();
        const auto size = static_cast<std::size_t>(expected.size);
        CHECK(v.camera.width == expected.size);
        CHECK(v.camera.height == expected.size);
        CHECK(v.pixels.width == expected.size);
        CHECK(v.pixels.height == expected.size);
        CHECK(v.pixels.rgba.size() == 4 * size * size);
        CHECK(v.camera.cx == 0.5 * expected.size);
        CHECK(v.camera.cy == 0.5 * expected.size);
        CHECK(v.camera.fx == v.camera.fy);
        CHECK(v.camera.fx * std::tan(22.5 / 180 * 3.14159265358979) == doctest::Approx(0.5 * expected.size));
    }
    CHECK(message_of("spheres", 0).find("resolution") != std::string::npos);
    CHECK(message_of("spheres", -4).find("-4") != std::string::npos);
}

TEST_CASE("synthetic scenes: without eval every view trains, under its own name") {
    const gs::scene all = make("spheres", 8, false);
    CHECK(all.train.size() == 48);
    CHECK(all.test.empty());
    std::set<std::string> names;
    for (const gs::view& v : all.train) names.insert(v.name);
    CHECK(names.size() == 48);

    const gs::scene split = make("spheres", 8, true);
    for (const gs::view& v : split.train) names.erase(v.name);
    CHECK(names.size() == 8);
    for (const gs::view& v : split.test) CHECK(names.count(v.name) == 1);
}

TEST_CASE("synthetic scenes: cameras look from the upper hemisphere at the center") {
    for (const gs::view& v : make("spheres", 8, false).train) {
        const glm::dmat3 product = v.camera.rotation * glm::transpose(v.camera.rotation);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) CHECK(std::abs(product[i][j] - (i == j)) < 1e-12);
        }
        CHECK(glm::determinant(v.camera.rotation) == doctest::Approx(1));
        CHECK(v.camera.center().z > 0);
        const pixel_position center = project(v.camera, {0, 0, 0});
        CHECK(center.x == doctest::Approx(v.camera.cx));
        CHECK(center.y == doctest::Approx(v.camera.cy));
        // Upright: a higher point of the world is higher in the image.
        CHECK(project(v.camera, {0, 0, 0.1}).y < center.y);
    }
}

TEST_CASE("synthetic scenes: points lie on what the cameras show, to the pixel") {
    for (const std::string& name : gs::synthetic_scene_names()) {
        CAPTURE(name);
        const gs::scene scene = make(name, 128);
        double farthest = 0;
        for (const gs::colored_point& p : scene.points) {
            farthest =
                std::max({farthest, std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)});
        }
        CHECK(farthest <= 1.3);
        // Points that other surfaces hide keep this far from 1; a camera off by a pixel finds fewer still.
        const double exact = share_found(scene, 0, 0);
        CHECK(exact > 0.3);
        for (const double one : {-1.0, 1.0}) {
            CHECK(share_found(scene, one, 0) < 0.85 * exact);
            CHECK(share_found(scene, 0, one) < 0.85 * exact);
        }
    }
}

TEST_CASE("synthetic scenes: no view sees through a surface point") {
    const gs::scene scene = make("alpha", 96);
    for (const gs::view& v : scene.train) {
        int uncovered = 0;
        for (const gs::colored_point& point : scene.points) {
            if (!covered_around(v.pixels, project(v.camera, point.position))) ++uncovered;
        }
        CHECK(uncovered == 0);
    }
}

TEST_CASE("synthetic scenes: alpha is premultiplied, spheres opaque") {
    const gs::scene transparent = make("alpha", 2);
    CHECK(transparent.has_alpha);
    for (const gs::view& v : transparent.train) {
        CHECK(v.pixels.has_alpha);
        bool premultiplied = true;
        int clear = 0, partial = 0, opaque = 0;
        for (std::size_t i = 0; i < v.pixels.rgba.size(); i += 4) {
            const std::uint8_t* p = &v.pixels.rgba[i];
            premultiplied = premultiplied && std::max({p[0], p[1], p[2]}) <= p[3];
            ++(p[3] == 0 ? clear : p[3] == 255 ? opaque : partial);
        }
        CHECK(premultiplied);
        CHECK(clear > 0);
        CHECK(partial > 0);
        CHECK(opaque > 0);
    }
    const gs::scene solid = make("spheres", 4);
    CHECK_FALSE(solid.has_alpha);
    for (const gs::view& v : solid.train) {
        CHECK_FALSE(v.pixels.has_alpha);
        for (std::size_t i = 3; i < v.pixels.rgba.size(); i += 4) REQUIRE(v.pixels.rgba[i] == 255);
    }
}

TEST_CASE("synthetic scenes: the same bits for any number of threads, other points for another seed") {
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const gs::scene one = make("spheres", 2);
    omp_set_num_threads(5);
    const gs::scene five = make("spheres", 2);
    omp_set_num_threads(threads);
    CHECK(same_views(one.train, five.train));
    CHECK(same_views(one.test, five.test));
    CHECK(same_points(one, five));

    const gs::scene other = make("spheres", 2, true, 1);
    CHECK(same_views(one.train, other.train));
    CHECK_FALSE(same_points(one, other));
    CHECK(same_points(one, make("spheres", 8)));
}

TEST_CASE("synthetic scenes: with fewer views, photos are the same ones of the whole scene") {
    const std::string world = "spheres,exposure=0.4,noise=0.02,passers=0.2";
    const gs::scene all = make(world, 24), few = make(world + ",views=5", 24);
    CHECK(few.train.size() == 5);
    CHECK(same_views(few.test, all.test));
    for (const gs::view& v : few.train) {
        CAPTURE(v.name);
        const auto same = std::ranges::find(all.train, v.name, &gs::view::name);
        REQUIRE(same != all.train.end());
        CHECK(same_views({v}, {*same}));
    }
}

TEST_CASE("synthetic scenes: what was made is said") {
    std::string said;
    gs::load_options options;
    options.data = "synthetic:alpha";
    options.eval = true;
    options.resolution = 8;
    gs::load_scene(options, [&](const std::string& line) { said += line; });
    CHECK(said.find("alpha") != std::string::npos);
    CHECK(said.find("40 training and 8 test views of 16x16") != std::string::npos);
}
