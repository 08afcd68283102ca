// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
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

TEST_CASE("a part of a render has the means of its blocks, or the chosen pixels") {
    const gs::scene scene = small_scene();
    const gs::camera camera = scene.train[0].camera.resized(45, 31);
    constexpr std::size_t width = 45, pixels = 45 * 31, side = 7, across = 6, down = 4;
    const std::vector<std::uint32_t> chosen{0, 44, 45, 700, 701, pixels - 1};
    for (const auto make : engines()) {
        const auto e = make();
        e->set_model(sphere_points(scene));
        for (const bool depths : {false, true}) {
            const std::size_t planes = depths ? 1 : 3;
            const auto all = e->render(camera, {1, 0, 0}, {.inverse_depth = depths});
            const auto blocks = e->render(camera, {1, 0, 0}, {.inverse_depth = depths, .block = side});
            const auto some = e->render(camera, {1, 0, 0}, {.inverse_depth = depths, .pixels = chosen});
            REQUIRE(all.size() == planes * pixels);
            REQUIRE(blocks.size() == planes * across * down);
            REQUIRE(some.size() == planes * chosen.size());
            for (std::size_t p = 0; p < planes; ++p) {
                for (std::size_t i = 0; i < chosen.size(); ++i)
                    CHECK(some[p * chosen.size() + i] == all[p * pixels + chosen[i]]);
                for (std::size_t row = 0; row < down; ++row)
                    for (std::size_t column = 0; column < across; ++column) {
                        double sum = 0;
                        for (std::size_t i = 0; i < side * side; ++i)
                            sum += static_cast<double>(
                                all[p * pixels + (row * side + i / side) * width + column * side + i % side]);
                        CHECK(static_cast<double>(blocks[(p * down + row) * across + column]) ==
                              doctest::Approx(sum / (side * side)).epsilon(1e-5));
                    }
            }
        }
    }
}
