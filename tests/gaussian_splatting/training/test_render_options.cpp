// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <vector>

#include "engines.hpp"
#include "scene/look_at.hpp"
#include "training/initialize.hpp"

namespace {

gs::gaussians sphere_points(const gs::scene& scene) { return gs::from_points(scene.points, 1, 5000, 1); }

/// A white, nearly opaque Gaussian at the origin.
gs::gaussians white_gaussian() {
    const std::vector<gs::colored_point> points{{{0, 0, 0}, {255, 255, 255}}};
    gs::gaussians model = gs::from_points(points, 0, 1, 1);
    model.opacity = {4};
    model.log_scale = {-1, -1, -1};
    return model;
}

}  // namespace

TEST_CASE("a render in separate memory is the same, and leaves the tile lists of training as they are") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {}, 0);
        e->set_model(sphere_points(scene));
        e->reserve();
        const gs::camera large = scene.train[0].camera.resized(300, 300);
        const std::uint64_t before = e->profile().forecast(5000, 1).total();
        const auto apart = e->render(large, {1, 1, 1}, {.separate_memory = true});
        CHECK(e->profile().forecast(5000, 1).total() == before);
        CHECK(apart == e->render(large, {1, 1, 1}));
        CHECK(e->profile().forecast(5000, 1).total() > before);
    }
}

TEST_CASE("a render of inverse depths has the weights of the colors") {
    for (const auto make : engines()) {
        const auto e = make();
        e->set_model(white_gaussian());
        constexpr int side = 32;
        for (const double distance : {2.0, 5.0}) {
            const gs::camera c = gs::look_at({0, -distance, 0}, {0, 0, 0}, {0, 0, 1}, side, 20);
            const auto colors = e->render(c, {0, 0, 0}, {.separate_memory = true});
            const auto depths = e->render(c, {0, 0, 0}, {.inverse_depth = true, .separate_memory = true});
            constexpr std::size_t pixels = std::size_t{side} * side;
            CHECK(colors[pixels / 2 + side / 2] > 0.5f);  // something is drawn
            REQUIRE(depths.size() == pixels);
            for (std::size_t i = 0; i < pixels; ++i)
                CHECK(depths[i] == doctest::Approx(colors[i] / distance).epsilon(1e-5));
        }
    }
}
