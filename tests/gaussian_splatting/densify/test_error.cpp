// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../training/engines.hpp"
#include "check_repeatable.hpp"
#include "densify/error/error_config.hpp"
#include "densify/error/error_kernels.hpp"
#include "model/opacity.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using gs::gaussians;
using gs::train::engine;
using gs::train::error_score;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
/// An iteration in which the model grows.
constexpr int grow_at = 600;

gs::train::training_setup error_setup(std::size_t cap, gs::train::error_config config = {}) {
    gs::train::training_setup setup = setup_with(gs::accumulator::fixed);
    setup.facts.iterations = 2000;
    setup.facts.max_gaussians = cap;
    setup.facts.extent = gs::internal_extent;
    setup.densification.name = "error";
    setup.densification.of<gs::train::error_config>() = config;
    return setup;
}

/// Returns the number of Gaussians after one step per view and one run of the strategy.
std::size_t count_after(engine& e, const gs::scene& scene, const gaussians& model,
                        const gs::train::training_setup& setup, int iteration = grow_at) {
    e.set_views(scene.train, {});
    e.set_model(model);
    e.begin(setup);
    e.reserve();
    auto still = plan_for(0);
    still.rates = {};
    for (still.view = 0; still.view < scene.train.size(); ++still.view) e.step(still);
    e.densify(iteration);
    return e.count();
}

/// The decision of `classify_by_error` about one Gaussian.
struct decision {
    bool stays, grows;
    bool operator==(const decision&) const = default;
};

decision decide(float opacity, gs::raster::visibility seen, error_score score) {
    std::vector<float> log_scale(gs::in_whole_blocks(1) * 3, -3), logit{gs::logit(opacity)};
    std::uint32_t stays = 7, large = 7, key = 7, identity = 7;
    unsigned long long without_gradient = 0;
    gs::parameter_arrays<const float> model;
    model.log_scale = log_scale.data();
    model.opacity = logit.data();
    gs::train::classify_by_error{model,
                                 &seen,
                                 &score,
                                 {.gradient = 1, .pixels = 2, .dense_scale = 1, .least_opacity = 0.005f},
                                 {&stays, &large, &key, &identity, &without_gradient}}(0);
    return {stays == 1, key != gs::train::growth_marks::never};
}

}  // namespace

TEST_CASE("error: pixels are wrong above the level, and masked pixels have no score") {
    const std::vector<std::uint8_t> photo{255, 255, 255, 255,  // white
                                          255, 255, 255, 255,  // white
                                          255, 255, 255, 0,    // masked
                                          0,   0,   0,   255,  // black
                                          0,   0,   0,   255};
    const std::vector<float> render{0.95f, 0.8f, 0, 9, not_a_number, 0.95f, 0.8f, 0, 0, not_a_number,
                                    0.95f, 0.8f, 0, 0, not_a_number};
    std::vector<float> scores(15, 7);
    const gs::train::target_image target{.rgba = photo.data(), .width = 5, .height = 1, .masked = true};
    for (std::size_t i = 0; i < 5; ++i)
        gs::train::score_pixels{target, render.data(), 5, 0.1f, scores.data()}(i);
    CHECK(scores == std::vector<float>{0, 1, 0, 1, 0, 1, 1, 0, 1, 1, 0, 0, 0, 0, 0});
}

TEST_CASE("error: a Gaussian grows where its gradient is large and several views are wrong") {
    const gs::raster::visibility steep{20, 10}, flat{5, 10};
    const decision stays{true, false}, grows{true, true}, goes{false, false};
    // {wrong, most_weight, views, wrong_views}
    CHECK(decide(0.5f, steep, {20, 30, 5, 2}) == grows);
    CHECK(decide(0.5f, flat, {20, 30, 5, 2}) == stays);
    CHECK(decide(0.5f, steep, {20, 30, 5, 1}) == stays);  // one view only, of several
    CHECK(decide(0.5f, steep, {9, 30, 5, 2}) == stays);   // too few wrong pixels
    CHECK(decide(0.5f, steep, {2, 30, 1, 1}) == grows);   // one view draws it
    CHECK(decide(0.5f, steep, {0, 0, 0, 0}) == grows);    // no view draws it
    CHECK(decide(0.5f, {0, 0}, {0, 0, 0, 0}) == stays);
    CHECK(decide(0.004f, steep, {20, 30, 5, 2}) == goes);
    CHECK(decide(0.5f, steep, {20, 0.4f, 3, 2}) == goes);  // three views show hardly any of it
    CHECK(decide(0.5f, steep, {1, 0.4f, 2, 0}) == stays);
    CHECK(decide(0, steep, {20, 30, 5, 2}) == goes);
    CHECK(decide(1, steep, {20, 30, 5, 2}) == grows);
    CHECK(decide(not_a_number, steep, {20, 30, 5, 2}) == goes);
    CHECK(decide(0.5f, {not_a_number, 10}, {20, 30, 5, 2}) == stays);
    CHECK(decide(0.5f, steep, {not_a_number, not_a_number, 5, 2}) == stays);
}

TEST_CASE("error: sums that are not finite leave a score as it is") {
    std::vector<float> sums(gs::raster::record_stride);
    const std::uint32_t tiles = 1;
    error_score score{};
    const gs::train::add_error_score add{&tiles, sums.data(), &score};
    sums[gs::raster::sum_red] = 2;
    sums[gs::raster::sum_green] = 3;
    add(0);
    sums[gs::raster::sum_red] = not_a_number;
    add(0);
    sums[gs::raster::sum_red] = 0.25f;
    sums[gs::raster::sum_green] = 1;
    add(0);
    CHECK(score.wrong == 2.25f);
    CHECK(score.most_weight == 3);
    CHECK(score.views == 2);
    CHECK(score.wrong_views == 1);
}

TEST_CASE("error: the model grows up to the cap, and not if no pixel is wrong") {
    const gs::scene scene = small_scene();
    const gaussians model = gs::from_points(scene.points, 0, 400, 1);
    for (const auto make : engines()) {
        const auto e = make();
        const std::size_t grown = count_after(*e, scene, model, error_setup(100000));
        CHECK(grown > 420);
        CHECK(count_after(*e, scene, model, error_setup(grown - 10)) == grown - 10);
        CHECK(count_after(*e, scene, model, error_setup(1)) <= 400);
        CHECK(count_after(*e, scene, model, error_setup(100000, {.level = 1})) <= 400);
        CHECK(count_after(*e, scene, model, error_setup(100000, {.pixels = 1e9})) <= 400);
        CHECK(count_after(*e, scene, model, error_setup(100000, {.views = 1})) != grown);
    }
}

TEST_CASE("error: after the last growth, a fifth of the Gaussians goes") {
    const gs::scene scene = small_scene();
    const gaussians model = gs::from_points(scene.points, 0, 400, 1);
    for (const auto make : engines()) {
        const auto e = make();
        auto setup = error_setup(1000);
        setup.facts.views = static_cast<int>(scene.train.size());
        e->begin(setup);
        CHECK(count_after(*e, scene, model, setup, e->timetable().count_is_final_after()) == 320);
    }
}

TEST_CASE("error: a model whose Gaussians are all transparent becomes empty, and stays so") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 100, 1);
    std::ranges::fill(model.opacity, gs::logit(0));
    for (const auto make : engines()) {
        const auto e = make();
        CHECK(count_after(*e, scene, model, error_setup(1000)) == 0);
        CHECK(e->densify(grow_at + 100) == 0);
        CHECK(e->count() == 0);
    }
}

TEST_CASE("long: error: training is repeatable with fixed point, for any number of threads") {
    const gs::scene scene = small_scene("synthetic:spheres,views=6", 24);
    gs::train::train_options o;
    o.schedule.iterations = 1500;
    o.schedule.sh_degree = 1;
    o.densification.name = "error";
    o.densification.of<gs::train::error_config>() = {.level = 0.005, .pixels = 0.1};
    o.max_cap = 600;
    o.gradient = gs::accumulator::fixed;
    CHECK(check_repeatable(scene, o) > 240);  // a fifth of the Gaussians goes at the end
}
