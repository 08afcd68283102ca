// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "../training/engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "evaluation/training_views.hpp"
#include "training/initialize.hpp"

namespace {

/// A scene whose training views are also its held-out views. The first one is partly masked.
gs::scene same_views() {
    gs::scene scene = small_scene("synthetic:spheres", 32);
    scene.train.resize(2);
    for (std::size_t pixel = 0; pixel < 300; ++pixel) scene.train[0].pixels.mask_pixel(pixel);
    scene.test = scene.train;
    return scene;
}

}  // namespace

TEST_CASE("training views have the PSNR of held-out views") {
    const gs::scene scene = same_views();
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, scene.test);
    engine->set_model(gs::from_points(scene.points, 0, 1000, 1));
    const auto expected = gs::evaluate::measure_held_out_views(*engine, scene, {0, 0, 0});
    for (std::size_t view = 0; view < 2; ++view) {
        const auto images = gs::evaluate::training_view(*engine, scene, {}, {0, 0, 0}, view);
        CHECK(images.psnr() == doctest::Approx(expected.views[view].quality.psnr()).epsilon(1e-4));
        CHECK(images.masked == (view == 0 ? 300 : 0));
        const bool is_equal =
            std::equal(images.render.begin(), images.render.begin() + 300, images.target.begin());
        CHECK(is_equal == (view == 0));
    }
}

TEST_CASE("learned effects change the renders of training views") {
    const gs::scene scene = same_views();
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, scene.test);
    engine->set_model(gs::from_points(scene.points, 0, 1000, 1));
    const auto show = [](std::size_t view, const gs::train::rendered_pixels&, std::vector<float>& render) {
        for (float& value : render) value = view == 1 ? 0.5F : value;
    };
    const auto images = gs::evaluate::training_view(*engine, scene, show, {0, 0, 0}, 1);
    CHECK(images.render == std::vector<float>(3 * 32 * 32, 0.5F));
}
