// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "../training/engines.hpp"
#include "check_repeatable.hpp"
#include "densify/mcmc/mcmc_config.hpp"
#include "densify/mcmc/mcmc_kernels.hpp"
#include "model/opacity.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using gs::gaussians;
using gs::train::engine;

/// An iteration in which the strategy runs, and one in which it does nothing but its work of each step.
constexpr int run_at = 600, between = 650;

gs::train::training_setup mcmc_setup(std::size_t cap, gs::train::mcmc_config config = {}) {
    gs::train::training_setup setup = setup_with(gs::accumulator::fixed);
    setup.facts.max_gaussians = cap;
    setup.facts.extent = gs::internal_extent;
    setup.densification.name = "mcmc";
    setup.densification.of<gs::train::mcmc_config>() = config;
    return setup;
}

/// Returns the model after one run of the strategy.
gaussians run_once(engine& e, const gaussians& model, std::size_t cap, int iteration = run_at) {
    e.set_model(model);
    e.begin(mcmc_setup(cap));
    e.densify(iteration);
    return e.get_model();
}

/// Returns the model after one step that shows none of the Gaussians, which are behind all cameras.
gaussians step_once(engine& e, const gaussians& model, const gs::train::mcmc_config& config,
                    std::uint64_t seed = 0) {
    e.set_model(model);
    auto setup = mcmc_setup(model.count(), config);
    setup.facts.seed = seed;
    e.begin(setup);
    e.reserve();
    auto plan = plan_for(0);
    plan.iteration = between;
    plan.rates = {};
    plan.rates[static_cast<std::size_t>(gs::parameter::mean)] = 1e-4f;
    plan.rates[static_cast<std::size_t>(gs::parameter::log_scale)] = 0.01f;
    plan.rates[static_cast<std::size_t>(gs::parameter::opacity)] = 0.02f;
    e.step(plan);
    return e.get_model();
}

bool are_equal(const gaussians& a, const gaussians& b) {
    return a.mean == b.mean && a.log_scale == b.log_scale && a.quaternion == b.quaternion &&
           a.opacity == b.opacity && a.sh_constant == b.sh_constant && a.sh_rest == b.sh_rest;
}

/// Returns `count` Gaussians of this opacity far from the cameras of `scene`, one per position.
gaussians hidden_crowd(std::size_t count, float opacity) {
    std::vector<gs::colored_point> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back({{1000 + 0.5 * static_cast<double>(i), 0, 0}, {}});
    gaussians model = gs::from_points(points, 0, count, 1);
    std::ranges::fill(model.opacity, gs::logit(opacity));
    return model;
}

std::vector<float> place(const gaussians& g, std::size_t i) {
    const auto first = g.mean.begin() + static_cast<std::ptrdiff_t>(3 * i);
    return {first, first + 3};
}
/// Returns the number of Gaussians at each place.
std::map<std::vector<float>, std::uint32_t> copies_in(const gaussians& g) {
    std::map<std::vector<float>, std::uint32_t> copies;
    for (std::size_t i = 0; i < g.count(); ++i) ++copies[place(g, i)];
    return copies;
}

}  // namespace

TEST_CASE("mcmc: the opacity and scale of copies are those of equation 9") {
    for (const double opacity : {0.005, 0.1, 0.5, 0.9, 0.99, 1 - 0x1p-24})
        for (const std::uint32_t copies : {1u, 2u, 3u, 7u, 20u}) {
            CAPTURE(opacity);
            CAPTURE(copies);
            const gs::train::relocated each = gs::train::relocate(opacity, copies);
            CHECK(std::pow(1 - each.opacity, copies) == doctest::Approx(1 - opacity).epsilon(1e-9));
            long double term = 1, sum = 0;  // sum over k of (copies over k) (-1)^(k + 1) q^k / sqrt(k)
            for (std::uint32_t k = 1; k <= copies; ++k) {
                term *= static_cast<long double>(copies - k + 1) / k * each.opacity;
                sum += (k % 2 == 1 ? term : -term) / std::sqrt(static_cast<long double>(k));
            }
            CHECK(each.scale == doctest::Approx(static_cast<double>(opacity / sum)).epsilon(1e-9));
        }
}

TEST_CASE("mcmc: the scale of any number of copies is between zero and one") {
    for (const double opacity : {0.005, 0.5, 1 - 0x1p-24}) {
        double before = 1;
        for (std::uint32_t copies = 1; copies < 100'000'000; copies *= 10) {
            const gs::train::relocated each = gs::train::relocate(opacity, copies);
            CHECK(each.opacity > 0);
            CHECK(each.scale > 0.4);
            CHECK(each.scale <= before + 1e-6);  // the opacity of many copies is rounded
            before = each.scale;
        }
    }
}

TEST_CASE("mcmc: runs at its interval until five sixths of the iterations") {
    const auto e = gs::train::make_cpu_engine();
    auto setup = mcmc_setup(10);
    setup.facts.iterations = 1234;
    e->begin(setup);
    const gs::train::timetable& t = e->timetable();
    CHECK(t.count_is_final_after() == 1028);
    for (const int iteration : {1, 100, 199, 201, 1100, 1200}) CHECK_FALSE(t.due(iteration));
    for (const int iteration : {200, 300, 1000}) CHECK(t.due(iteration));
    CHECK_FALSE(t.wants(600));
    setup.facts.iterations = 7000;
    e->begin(setup);
    CHECK_FALSE(e->timetable().due(500));
    CHECK(e->timetable().due(600));
}

TEST_CASE("mcmc: dead Gaussians move to live ones, which share their appearance") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 1, 400, 1);
    for (std::size_t i = 0; i < 400; ++i) model.opacity[i] = gs::logit(i % 4 == 0 ? 0.004f : 0.3f);
    for (const auto make : engines()) {
        const auto e = make();
        const gaussians moved = run_once(*e, model, 400);
        REQUIRE(moved.count() == 400);
        auto copies = copies_in(moved);
        std::size_t moved_here = 0, at = 0;  // copies lie beside each other, in the order of their origins
        for (std::size_t i = 0; i < 400; ++i) {
            const std::uint32_t n = copies[place(model, i)];
            if (i % 4 == 0) {
                CHECK(n == 0);
                continue;
            }
            REQUIRE(n >= 1);
            moved_here += n - 1;
            const gs::train::relocated each = gs::train::relocate(0.3, n);
            for (const std::size_t end = at + n; at < end; ++at) {
                CHECK(place(moved, at) == place(model, i));
                CHECK(gs::sigmoid(moved.opacity[at]) == doctest::Approx(each.opacity).epsilon(1e-4));
                CHECK(std::exp(moved.log_scale[3 * at] - model.log_scale[3 * i]) ==
                      doctest::Approx(each.scale).epsilon(1e-4));
                if (n > 1) continue;
                CHECK(moved.opacity[at] == model.opacity[i]);
                CHECK(moved.log_scale[3 * at] == model.log_scale[3 * i]);
            }
        }
        REQUIRE(at == 400);
        CHECK(moved_here == 100);
    }
}

TEST_CASE("mcmc: opaque Gaussians receive more copies") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 1000, 1);
    for (std::size_t i = 0; i < 1000; ++i) model.opacity[i] = gs::logit(i % 2 == 0 ? 0.9f : 0.1f);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_model(model);
        auto setup = mcmc_setup(2000);
        setup.facts.iterations = 840;  // the last run is at 700
        e->begin(setup);
        e->densify(700);
        const gaussians grown = e->get_model();
        REQUIRE(grown.count() == 2000);
        auto copies = copies_in(grown);
        std::size_t opaque = 0, faint = 0;
        for (std::size_t i = 0; i < 1000; ++i)
            if (copies[place(model, i)] > 1) ++(i % 2 == 0 ? opaque : faint);
        // 1000 draws: each opaque one is hit 1.8 times in the mean, each faint one 0.2 times.
        CHECK(opaque > 380);
        CHECK(opaque < 450);
        CHECK(faint > 60);
        CHECK(faint < 125);
    }
}

TEST_CASE("mcmc: reaches the cap in the last run and never exceeds it") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 100, 1);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_model(model);
        auto setup = mcmc_setup(1000);
        setup.facts.iterations = 1800;
        e->begin(setup);
        std::size_t before = 100;
        for (int iteration = 1; iteration <= 1800; ++iteration) {
            if (!e->timetable().due(iteration)) continue;
            e->densify(iteration);
            CHECK(e->count() > before);
            CHECK(static_cast<double>(e->count()) < 1.4 * static_cast<double>(before));
            before = e->count();
        }
        CHECK(before == 1000);
        // A cap below the number of Gaussians removes none.
        CHECK(run_once(*e, model, 1).count() == 100);
    }
}

TEST_CASE("mcmc: one Gaussian, none, all dead and none dead") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = make();
        gaussians model = gs::from_points(scene.points, 1, 50, 1);
        CHECK(are_equal(run_once(*e, model, 50), model));  // none dead
        std::ranges::fill(model.opacity, gs::logit(0));
        CHECK(are_equal(run_once(*e, model, 500), model));  // all dead
        model.opacity[7] = gs::logit(1);                    // one lives, and is opaque
        const gaussians one_lived = run_once(*e, model, 50);
        for (std::size_t i = 0; i < 50; ++i) {
            CHECK(one_lived.mean[3 * i] == model.mean[3 * 7]);
            CHECK(std::isfinite(one_lived.log_scale[3 * i]));
            CHECK(gs::sigmoid(one_lived.opacity[i]) > gs::train::dead_opacity);
        }
        const gaussians one = gs::from_points(scene.points, 0, 1, 1);
        CHECK(are_equal(run_once(*e, one, 1), one));
        CHECK(run_once(*e, one, 3).count() == 2);
        CHECK(run_once(*e, {}, 10).count() == 0);
    }
}

TEST_CASE("mcmc: a Gaussian whose opacity is not a number is dead") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 0, 50, 1);
    for (const float bad : {std::nanf(""), -std::numeric_limits<float>::infinity()}) {
        model.opacity[3] = bad;
        for (const auto make : engines()) {
            const auto e = make();
            const gaussians moved = run_once(*e, model, 50);
            CHECK(moved.mean[9] != model.mean[9]);
            for (const float opacity : moved.opacity) CHECK(std::isfinite(opacity));
        }
    }
}

TEST_CASE("mcmc: noise moves transparent Gaussians, along their axes and by their size") {
    const gs::scene scene = small_scene();
    constexpr std::size_t count = 3000;
    gs::train::mcmc_config noise_only;
    noise_only.opacity_penalty = noise_only.scale_penalty = 0;
    gaussians model = hidden_crowd(count, 0.001f);
    for (std::size_t i = 0; i < count; ++i) {
        model.log_scale[3 * i] = std::log(0.4f);
        model.log_scale[3 * i + 1] = std::log(0.2f);
        model.log_scale[3 * i + 2] = std::log(0.1f);
        model.quaternion[4 * i] = std::cos(0.25f);  // a turn by half a radian about z
        model.quaternion[4 * i + 3] = std::sin(0.25f);
        if (i % 2 == 1) model.opacity[i] = gs::logit(0.5f);
    }
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {});
        const gaussians moved = step_once(*e, model, noise_only);
        CHECK(moved.opacity == model.opacity);
        CHECK(moved.log_scale == model.log_scale);
        double square[3] = {}, sum[3] = {}, product = 0;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto by = static_cast<double>(moved.mean[3 * i + k] - model.mean[3 * i + k]);
                if (i % 2 == 1) {
                    CHECK(by == 0);
                    continue;
                }
                sum[k] += by;
                square[k] += by * by;
                if (k == 1) product += by * static_cast<double>(moved.mean[3 * i] - model.mean[3 * i]);
            }
        // sigmoid(100 (0.005 - 0.001)) times noise times the rate, over the square of the extent.
        const double strength = 0.5986876601 * 5e5 * 1e-4 / 16;
        // The noise is the covariance of the Gaussian times a normal vector.
        const double c = std::cos(0.5), s = std::sin(0.5), xx = 0.16 * c * c + 0.04 * s * s,
                     yy = 0.16 * s * s + 0.04 * c * c, xy = (0.16 - 0.04) * c * s;
        const double variances[3] = {xx * xx + xy * xy, xy * xy + yy * yy, 1e-4};
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(square[k] / (count / 2) ==
                  doctest::Approx(strength * strength * variances[k]).epsilon(0.15));
            CHECK(std::abs(sum[k] / (count / 2)) < 0.1 * strength * std::sqrt(variances[k]));
        }
        CHECK(product / (count / 2) == doctest::Approx(strength * strength * xy * (xx + yy)).epsilon(0.15));
        CHECK(are_equal(step_once(*e, model, noise_only), moved));
        CHECK_FALSE(are_equal(step_once(*e, model, noise_only, 1), moved));
    }
}

TEST_CASE("mcmc: penalties lower opacities and scales by at most a tenth of the learning rate") {
    const gs::scene scene = small_scene();
    const gaussians model = hidden_crowd(100, 0.4f);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {});
        const gaussians after = step_once(*e, model, {});
        CHECK(after.mean == model.mean);
        for (std::size_t i = 0; i < 100; ++i) {  // no view shows them, so their second moments are zero
            CHECK(after.opacity[i] == doctest::Approx(model.opacity[i] - 0.002f));
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
                CHECK(after.log_scale[k] == doctest::Approx(model.log_scale[k] - 0.001f));
        }
        CHECK(are_equal(step_once(*e, model, {.opacity_penalty = 0, .scale_penalty = 0}), model));
    }
}

TEST_CASE("mcmc: a step whose tile lists exceed the capacity adds no noise") {
    std::vector<float> mean(3 * gs::block_length), log_scale(3 * gs::block_length),
        quaternion(4 * gs::block_length, 0.5f), opacity(gs::block_length, -9);
    gs::train::add_noise noise{};
    noise.values = {mean.data(), log_scale.data(), quaternion.data(), opacity.data()};
    noise.strength = 1;
    const std::uint64_t required = 11;
    noise.capacity = {&required, 10};
    noise(0);
    CHECK(mean[0] == 0);
    noise.capacity = {&required, 11};
    noise(0);
    CHECK(mean[0] != 0);
}

TEST_CASE("mcmc: Gaussians with copies and the copies have no moments, and others keep theirs") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 1, 300, 1);
    for (std::size_t i = 0; i < 300; i += 4) model.opacity[i] = gs::logit(0.004f);
    constexpr auto color = static_cast<std::size_t>(gs::parameter::sh0);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {});
        e->set_model(model);
        e->begin(mcmc_setup(300, {.noise = 0, .opacity_penalty = 0, .scale_penalty = 0}));
        e->reserve();
        auto plan = plan_for(0);
        plan.rates = {};
        e->step(plan);  // gives moments to the visible Gaussians
        e->densify(run_at);
        e->reserve();
        const gaussians before = e->get_model();
        plan.view = 1;
        plan.iteration = 2;
        plan.rates[color] = 0.01f;
        e->step(plan);
        const gaussians after = e->get_model();
        // Without moments, Adam's second step moves by the rate times 0.1 / (1 - 0.81) over
        // sqrt(0.001 / (1 - 0.998)).
        const double alone = 0.01 * 0.1 / (1 - 0.81) / std::sqrt(0.001 / (1 - 0.999 * 0.999));
        auto copies = copies_in(before);
        std::size_t fresh = 0, others = 0;
        for (std::size_t i = 0; i < 300; ++i) {
            const bool has_copies = copies[place(before, i)] > 1;
            const double moved =
                std::abs(static_cast<double>(after.sh_constant[3 * i] - before.sh_constant[3 * i]));
            if (moved == 0) continue;
            const bool is_alone = std::abs(moved - alone) < 0.01 * alone;
            if (has_copies) {
                CHECK(is_alone);
                ++fresh;
            } else {
                others += is_alone ? 0 : 1;
            }
        }
        CHECK(fresh > 20);
        CHECK(others > 20);
    }
}

TEST_CASE("mcmc: hides Gaussians near a training camera at each interval and at the end") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points({{scene.train[0].camera.center(), {}}}, 0, 1, 1);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {});
        for (const int iteration : {99, 100, 7000}) {
            e->set_model(model);
            e->begin(mcmc_setup(1));
            e->adjust(iteration);
            CHECK((e->get_model().opacity[0] == gs::logit(0)) == (iteration != 99));
        }
    }
}

TEST_CASE("counter_random: whole numbers are below the limit, and all occur alike") {
    std::vector<int> counts(10);
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const std::uint64_t n = gs::train::counter_random(1, 2, i).below(10);
        REQUIRE(n < 10);
        ++counts[n];
    }
    for (const int n : counts) CHECK(std::abs(n - 2000) < 200);
    CHECK(gs::train::counter_random(1, 2, 3).below(1) == 0);
}

TEST_CASE("mcmc: extreme Gaussians stay finite") {
    const gs::scene scene = small_scene();
    gaussians model = hidden_crowd(64, 0.001f);
    for (std::size_t i = 0; i < 64; ++i) {
        model.opacity[i] = i % 2 == 0 ? gs::logit(0) : gs::logit(1);
        model.log_scale[3 * i] = i % 3 == 0 ? 120.0f : i % 3 == 1 ? -120.0f : 40.0f;
        if (i % 5 == 0) std::fill_n(&model.quaternion[4 * i], 4, 0.0f);
    }
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {});
        const gaussians after = step_once(*e, model, {});
        for (const float x : after.mean) CHECK(std::isfinite(x));
        for (const float x : after.log_scale) CHECK(std::isfinite(x));
        for (const float x : after.opacity) CHECK(std::isfinite(x));
        for (const float x : run_once(*e, after, 100).log_scale) CHECK(std::isfinite(x));
    }
}

TEST_CASE("long: mcmc: training is repeatable with fixed point, for any number of threads") {
    const gs::scene scene = small_scene();
    gs::train::train_options o;
    o.schedule.iterations = 900;
    o.schedule.sh_degree = 1;
    o.densification.name = "mcmc";
    o.max_cap = 600;
    o.gradient = gs::accumulator::fixed;
    CHECK(check_repeatable(scene, o) == 600);
}
