// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "engines.hpp"
#include "render/tiles/view_stack.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

gs::camera camera_of(int width, int height) {
    gs::camera camera;
    camera.width = width;
    camera.height = height;
    return camera;
}

/// Returns the largest difference between two lists.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    return most;
}

/// Returns the model after one step with these views.
gs::gaussians after_step(make_engine make, const gs::scene& scene, const std::vector<std::size_t>& views) {
    const auto e = make();
    e->set_views(scene.train, scene.test);
    e->set_model(gs::from_points(scene.points, 0, 1000, 1));
    auto setup = setup_with(gs::accumulator::fixed);
    setup.batch_size = views.size();
    e->begin(setup);
    e->reserve();
    e->step(plan_for(views[0]), {views.begin() + 1, views.end()});
    CHECK(e->take_report().skipped == 0);
    return e->get_model();
}

}  // namespace

TEST_CASE("batch: views lie one below the other, each from a tile row on") {
    const gs::raster::view_stack one(camera_of(50, 30)), both({camera_of(50, 30), camera_of(20, 70)});
    CHECK(one.width() == 50);
    CHECK(one.height() == 30);
    CHECK(one.tiles_down() == 2);
    CHECK(one.rows_of(0, {16, 30}) == gs::row_range{16, 30});
    CHECK(both.width() == 50);
    CHECK(both.tiles_of_view() == 5);
    CHECK(both.height() == 160);
    CHECK(both.first_row(1) == 80);
    CHECK(both.rows_of(0, {16, 100}) == gs::row_range{16, 30});
    CHECK(both.rows_of(1, {16, 100}) == gs::row_range{0, 20});
    CHECK(both.rows_of(1, {0, 80}).count() == 0);
    CHECK_THROWS_AS(gs::raster::view_stack({gs::camera::panorama(64, 32), camera_of(64, 32)}), gs::error);
    CHECK_THROWS_AS(gs::raster::view_stack({gs::camera::panorama(64, 32), gs::camera::panorama(96, 48)}),
                    gs::error);
}

TEST_CASE("batch: a step adds the gradients of its views") {
    const gs::scene scene = small_scene("synthetic:spheres,views=6");
    for (const auto make : engines()) {
        const auto first = gs::from_points(scene.points, 0, 1000, 1);
        const auto alone = after_step(make, scene, {0}), other = after_step(make, scene, {1}),
                   twice = after_step(make, scene, {0, 0}), both = after_step(make, scene, {0, 1});
        // The first step of Adam depends on the signs of gradients only, and those of a view and of its
        // double are the same.
        CHECK(difference(alone.mean, twice.mean) < 1e-6);
        CHECK(difference(alone.sh_constant, twice.sh_constant) < 1e-6);
        CHECK(difference(alone.opacity, twice.opacity) < 1e-6);
        // Where both views ask for the same change, the step makes it.
        std::size_t agreed = 0, kept = 0, differ = 0;
        for (std::size_t i = 0; i < first.opacity.size(); ++i) {
            const float a = alone.opacity[i] - first.opacity[i], b = other.opacity[i] - first.opacity[i],
                        c = both.opacity[i] - first.opacity[i];
            if (a * b > 0) {
                ++agreed;
                kept += c * a > 0 ? 1u : 0u;
            } else if (a == 0 && b != 0) {
                differ += c * b > 0 ? 0u : 1u;
            }
        }
        CHECK(agreed > 100);
        CHECK(kept == agreed);
        CHECK(differ == 0);
    }
}

TEST_CASE("batch: training with photos of different sizes brings views near the photos") {
    gs::scene scene = small_scene("synthetic:spheres,views=8");
    gs::view& narrow = scene.train[0];
    const int width = narrow.camera.width, kept = width - 11;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < narrow.camera.height; ++y) {
        const auto row = narrow.pixels.rgba.begin() + std::ptrdiff_t{4} * y * width;
        rgba.insert(rgba.end(), row, row + std::ptrdiff_t{4} * kept);
    }
    narrow.pixels.rgba = rgba;
    narrow.camera.width = kept;
    for (const auto make : engines()) {
        const auto e = make();
        gs::train::train_options o;
        e->set_views(scene.train, scene.test);
        e->set_model(gs::from_points(scene.points, 0, 2000, 1));
        o.schedule.iterations = 200;
        o.schedule.sh_degree = 0;
        o.schedule.num_downscales = 0;
        o.max_cap = 3000;
        o.batch_size = 3;
        const double before = e->measure(0, {}).psnr();
        const auto result = gs::train::train(*e, scene, o, {[](const auto&) {}, [](int) {}, [](int) {}});
        CHECK(result.skipped_steps == 0);
        CHECK(e->measure(0, {}).psnr() > before + 3);
        o.batch_size = scene.train.size() + 1;
        CHECK_THROWS_AS(gs::train::train(*e, scene, o, {[](const auto&) {}, [](int) {}, [](int) {}}),
                        gs::error);
    }
}
