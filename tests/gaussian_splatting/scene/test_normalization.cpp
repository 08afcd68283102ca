// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <string>

#include "../../support/temporary_folder.hpp"
#include "evaluation/held_out_views.hpp"
#include "readers/load_scene.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"
#include "writers/ply/ply.hpp"

namespace {

const auto silent = [](const std::string&) {};

gs::scene spheres(int resolution) {
    gs::load_options o;
    o.data = "synthetic:spheres";
    o.resolution = resolution;
    o.eval = true;
    return gs::load_scene(o, silent);
}

/// Returns the scene in other coordinates: scale * (x + offset).
gs::scene displaced(gs::scene scene, const glm::dvec3& offset, double scale) {
    for (auto* views : {&scene.train, &scene.test})
        for (gs::view& v : *views)
            v.camera.translation = scale * (v.camera.translation - v.camera.rotation * offset);
    for (gs::colored_point& p : scene.points) p.position = scale * (p.position + offset);
    return scene;
}

struct displacement {
    double offset, scale;
    glm::dvec3 vector() const { return {offset, -offset, offset}; }
};
constexpr displacement displacements[] = {{1e4, 1}, {0, 1e-4}, {0, 1e4}, {1e4, 1e-4}, {1e4, 1e4}};

gs::scene seen_from(std::initializer_list<glm::dvec3> centers) {
    gs::scene s;
    for (const glm::dvec3& center : centers) {
        s.train.emplace_back();
        s.train.back().camera.translation = -center;
    }
    return s;
}

bool is_sane(const gs::normalization& f) {
    return std::isfinite(f.scale) && f.scale > 0 && std::isfinite(glm::length(f.origin));
}

gs::gaussians trained(gs::train::engine& engine, const gs::scene& scene) {
    gs::train::train_options o;
    engine.set_views(scene.train, scene.test, o.schedule.num_downscales);
    engine.set_model(gs::from_points(scene.points, 0, 3000, 1));
    o.schedule.iterations = 200;
    o.densification.of<gs::train::adaptive_config>().densify_from_iter = 50;
    o.densification.of<gs::train::adaptive_config>().densification_interval = 25;
    o.max_cap = 4000;
    const gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    gs::train::train(engine, scene, o, events);
    return engine.get_model();
}

double psnr_of(gs::train::engine& engine, const gs::scene& scene) {
    return gs::evaluate::measure_held_out_views(engine, scene, {}, {}).psnr();
}

double median_along(const gs::gaussians& model, std::size_t axis) {
    std::vector<float> x;
    for (std::size_t i = 0; i < model.count(); ++i) x.push_back(model.mean[3 * i + axis]);
    std::ranges::nth_element(x, x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2));
    return static_cast<double>(x[x.size() / 2]);
}

}  // namespace

TEST_CASE("internal coordinates are the same wherever a scene lies and whatever its unit") {
    const gs::scene scene = spheres(16);
    gs::scene near = scene;
    gs::normalize(near, silent);
    CHECK(near.extent() == doctest::Approx(gs::internal_extent).epsilon(1e-12));
    CHECK(near.normalization.scale == doctest::Approx(scene.extent() / gs::internal_extent).epsilon(1e-12));
    for (const displacement& d : displacements) {
        CAPTURE(d.offset);
        CAPTURE(d.scale);
        gs::scene far = displaced(scene, d.vector(), d.scale);
        gs::normalize(far, silent);
        const double rounding = 1e-14 * (10 + d.offset);
        CHECK(far.extent() == doctest::Approx(gs::internal_extent).epsilon(rounding));
        for (std::size_t i = 0; i < scene.train.size(); ++i) {
            const gs::camera &a = near.train[i].camera, &b = far.train[i].camera;
            CHECK(glm::distance(a.translation, b.translation) < rounding);
            CHECK(b.rotation == a.rotation);
            CHECK(b.fx == a.fx);
        }
        CHECK(glm::distance(near.test[0].camera.translation, far.test[0].camera.translation) < rounding);
        for (std::size_t i = 0; i < scene.points.size(); ++i)
            REQUIRE(glm::distance(near.points[i].position, far.points[i].position) < rounding);
        CHECK(glm::distance(*near.looked_at(), *far.looked_at()) < 1e-9 * (10 + d.offset));
    }
}

TEST_CASE("a pixel sees the same point in world and internal coordinates") {
    gs::scene scene = displaced(spheres(16), {3, 4, 5}, 20);
    const gs::scene original = scene;
    gs::normalize(scene, silent);
    for (std::size_t i = 0; i < 50; ++i) {
        const gs::camera &a = original.train[i % 40].camera, &b = scene.train[i % 40].camera;
        const glm::dvec3 p = a.rotation * original.points[i].position + a.translation;
        const glm::dvec3 q = b.rotation * scene.points[i].position + b.translation;
        CHECK(glm::distance(p / scene.normalization.scale, q) < 1e-12);
    }
}

TEST_CASE("a model is transformed to internal and world coordinates, rounded once") {
    gs::gaussians model = gs::from_points(spheres(16).points, 1, 500, 1);
    const gs::normalization f{{100, -200, 300}, 8};
    const gs::gaussians out = gs::to_world(f, model);
    CHECK(out.mean[4] == static_cast<float>(-200 + 8 * static_cast<double>(model.mean[4])));
    CHECK(out.log_scale[4] == static_cast<float>(static_cast<double>(model.log_scale[4]) + std::log(8.0)));
    CHECK(out.quaternion == model.quaternion);
    CHECK(out.sh_constant == model.sh_constant);
    CHECK(out.opacity == model.opacity);
    const gs::gaussians back = gs::to_internal(f, out);
    constexpr double half_ulp_at_300 = 0x1p-16;
    for (std::size_t i = 0; i < model.mean.size(); ++i)
        CHECK(std::abs(static_cast<double>(back.mean[i] - model.mean[i])) < 1.01 * half_ulp_at_300 / 8);
    for (std::size_t i = 0; i < model.log_scale.size(); ++i)
        CHECK(back.log_scale[i] == doctest::Approx(model.log_scale[i]).epsilon(1e-6));
    // A value that has been rounded once does not change again.
    CHECK(gs::to_world(f, back).mean == out.mean);
}

TEST_CASE("a scene without an extent has a normalization, too") {
    SUBCASE("a single camera, and its points") {
        gs::scene s = seen_from({{7, 8, 9}});
        s.points = {{{7, 8, 29}, {}}};
        CHECK(gs::normalization_of(s).scale == doctest::Approx(20 / gs::internal_extent));
        CHECK(gs::normalization_of(s).origin == glm::dvec3(7, 8, 9));
        gs::normalize(s, silent);
        CHECK(s.extent() == doctest::Approx(gs::internal_extent));
    }
    SUBCASE("a single camera that looks at the origin's side of the world") {
        gs::scene s = seen_from({{1, 0, -6}});
        CHECK(gs::normalization_of(s).scale == doctest::Approx(6 / gs::internal_extent));
        gs::normalize(s, silent);
        CHECK(s.extent() == doctest::Approx(gs::internal_extent));
    }
    SUBCASE("identical cameras that look away from it") {
        gs::scene s = seen_from({{0, 0, 5}, {0, 0, 5}});
        CHECK(gs::normalization_of(s).scale == doctest::Approx(1 / gs::internal_extent));
        gs::normalize(s, silent);
        CHECK(s.extent() == doctest::Approx(gs::internal_extent));
    }
    SUBCASE("the only point is where the only camera is") {
        gs::scene s = seen_from({{1, 2, 3}});
        s.points = {{{1, 2, 3}, {}}};
        CHECK(is_sane(gs::normalization_of(s)));
        CHECK(s.extent() > 0);
    }
    SUBCASE("coordinates that only double can hold") {
        for (const double far : {1e300, 1e-300, 1e-320}) {
            CAPTURE(far);
            CHECK(is_sane(gs::normalization_of(seen_from({{far, 0, 0}, {-far, 0, 0}}))));
            gs::scene s = seen_from({{0, 0, 0}});
            s.points = {{{0, far, 0}, {}}};
            CHECK(is_sane(gs::normalization_of(s)));
        }
    }
}

TEST_CASE("points that float could not hold are left out, with a word") {
    gs::scene s = seen_from({{-1, 0, 0}, {1, 0, 0}});
    s.points = {{{0, 0, 5}, {}}, {{0, 3, 5}, {}}, {{1e40, 0, 0}, {}}, {{0, 0, 8}, {}}, {{0, -1e300, 0}, {}}};
    std::string said;
    gs::normalize(s, [&](const std::string& line) { said += line; });
    CHECK(s.points.size() == 3);
    CHECK(said.find("dropped 2 of 5 points") != std::string::npos);
}

TEST_CASE("a model without a scene has a normalization") {
    gs::gaussians model = gs::from_points(spheres(16).points, 0, 500, 1);
    const gs::normalization near = gs::normalization_of(model);
    const gs::normalization far = gs::normalization_of(gs::to_world({{1e3, 2e3, 3e3}, 1e-2}, model));
    CHECK(glm::distance(far.origin, glm::dvec3(1e3, 2e3, 3e3) + 1e-2 * near.origin) < 2e-4);
    CHECK(far.scale == doctest::Approx(1e-2 * near.scale).epsilon(1e-2));

    for (std::size_t i = 0; i < 100; ++i) model.mean[3 * i] = 1e8F;  // floaters
    const gs::normalization robust = gs::normalization_of(model);
    CHECK(glm::distance(robust.origin, near.origin) < near.scale);
    CHECK(robust.scale < 2 * near.scale);

    gs::gaussians one = gs::from_points({{{5, 6, 7}, {}}}, 0, 1, 0);
    CHECK(gs::normalization_of(one).origin == glm::dvec3(5, 6, 7));
    CHECK(gs::normalization_of(one).scale == doctest::Approx(std::sqrt(1e-7)));
    for (const float size : {-1e30F, 1e30F}) {
        std::ranges::fill(one.log_scale, size);
        CHECK(is_sane(gs::normalization_of(one)));
    }
}

TEST_CASE("long: a distant scene, or one in another unit, trains alike and is written in world coordinates") {
    const gs::scene scene = spheres(32);
    const auto engine = gs::train::make_cpu_engine();
    gs::scene near = scene;
    gs::normalize(near, silent);
    trained(*engine, near);
    const double expected = psnr_of(*engine, near);
    REQUIRE(expected > 24);

    const gs_test::temporary_folder folder;
    for (const displacement& d : {displacement{1e4, 1}, {0, 1e-4}, {0, 1e4}}) {
        CAPTURE(d.offset);
        CAPTURE(d.scale);
        gs::scene far = displaced(scene, d.vector(), d.scale);
        gs::normalize(far, silent);
        const gs::gaussians model = trained(*engine, far);
        const double psnr = psnr_of(*engine, far);
        CHECK(std::abs(psnr - expected) < 0.1);

        gs::write_ply(folder / "model.ply", gs::to_world(far.normalization, model));
        const gs::gaussians file = gs::read_ply(folder / "model.ply");
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double world = d.vector()[static_cast<glm::length_t>(axis)];
            CHECK(std::abs(median_along(file, axis) / d.scale - world) < 0.5);  // of a world 2.6 wide
        }
        const gs::gaussians again = gs::to_internal(far.normalization, file);
        // Half a unit in the last place of the largest coordinate, in internal units.
        const double largest = d.scale * (d.offset + 3) / far.normalization.scale;
        const double resolved = 0.51 * static_cast<double>(std::numeric_limits<float>::epsilon()) * largest;
        double worst = 0;
        for (std::size_t i = 0; i < model.mean.size(); ++i)
            worst = std::max(worst, std::abs(static_cast<double>(again.mean[i] - model.mean[i])));
        CHECK(worst < 2 * resolved);
        if (d.offset > 0) CHECK(worst > 1e-4);  // the file does not have internal coordinates
        engine->set_model(again);
        CHECK(std::abs(psnr_of(*engine, far) - psnr) < (d.offset > 0 ? 0.1 : 0.001));
    }
}
