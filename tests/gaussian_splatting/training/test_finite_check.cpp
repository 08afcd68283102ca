// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "engines.hpp"
#include "model/opacity.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using gs::train::fault_kind;
using gs::train::fault_report;

constexpr float infinity = std::numeric_limits<float>::infinity();

const fault_report& of(const gs::train::fault_reports& all, fault_kind kind) {
    return all[static_cast<std::size_t>(kind)];
}

bool is_finite(const gs::gaussians& model) {
    for (const auto* values : {&model.mean, &model.log_scale, &model.quaternion, &model.opacity,
                               &model.sh_constant, &model.sh_rest})
        for (const float x : *values)
            if (!std::isfinite(x)) return false;
    return true;
}

/// Thirty Gaussians that the first view sees.
gs::gaussians few(const gs::scene& scene) { return gs::from_points(scene.points, 0, 30, 1); }

/// So short a quaternion that the gradient by it is beyond what Adam can square, in one Gaussian of all.
gs::gaussians one_short_quaternion(const gs::scene& scene, std::size_t which) {
    gs::gaussians model = few(scene);
    model.log_scale[3 * which] += 1;  // not a ball: turning it changes something
    const float tiny[] = {3e-37f, 1e-37f, 2e-37f, 0};
    std::copy_n(tiny, 4, model.quaternion.begin() + static_cast<std::ptrdiff_t>(4 * which));
    return model;
}

/// An engine that has the training views and a model, and room for its lists.
std::unique_ptr<gs::train::engine> ready(make_engine make, const gs::scene& scene,
                                         const gs::gaussians& model) {
    auto e = make();
    e->set_views(scene.train, {}, gs::train::schedule{}.num_downscales);
    e->set_model(model);
    e->begin(setup_with(gs::accumulator::native));
    e->reserve();
    return e;
}

gs::train::train_options short_run(int iterations) {
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    o.max_cap = 100;
    return o;
}

}  // namespace

TEST_CASE("a sound step leaves nothing to find") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = ready(make, scene, few(scene));
        e->step(plan_for(0));
        for (const fault_report& f : e->take_report().faults) CHECK(f.count == 0);
    }
}

TEST_CASE("a gradient that is not finite is left out, and found where it appears") {
    const gs::scene scene = small_scene();
    const gs::gaussians model = one_short_quaternion(scene, 17);
    for (const auto make : engines()) {
        const auto e = ready(make, scene, model);
        for (int iteration = 41; iteration <= 43; ++iteration) {
            auto plan = plan_for(0);
            plan.iteration = iteration;
            e->step(plan);
        }
        const auto found = e->take_report().faults;
        const fault_report& f = of(found, fault_kind::gradient);
        CHECK(f.count >= 3);   // an element or more, each time
        CHECK(f.count <= 12);  // of one Gaussian's four
        CHECK(f.iteration == 41);
        CHECK(f.parameter == gs::parameter::quaternion);
        CHECK(f.gaussian == 17);
        CHECK(of(found, fault_kind::loss).count == 0);
        CHECK(of(found, fault_kind::parameter).count == 0);
        CHECK(of(e->take_report().faults, fault_kind::gradient).count == 0);  // taken

        const gs::gaussians after = e->get_model();
        CHECK(is_finite(after));
        CHECK(after.opacity[17] != model.opacity[17]);  // the rest of it goes on learning
    }
}

TEST_CASE("a loss that is not finite is found where it appears, and moves nothing") {
    const gs::scene scene = small_scene();
    const gs::gaussians model = few(scene);
    for (const auto make : engines()) {
        const auto e = ready(make, scene, model);
        auto plan = plan_for(0);
        plan.iteration = 6;
        plan.background = {infinity, 0, 0};
        e->step(plan);
        plan.iteration = 7;
        e->step(plan);
        const auto found = e->take_report().faults;
        CHECK(of(found, fault_kind::loss).count == 2);
        CHECK(of(found, fault_kind::loss).iteration == 6);
        CHECK(is_finite(e->get_model()));
    }
}

TEST_CASE("a sum that fixed point cannot hold is left out, and found where it appears") {
    const gs::scene scene = small_scene();
    const gs::gaussians sound = few(scene);
    gs::gaussians bright = sound;
    bright.sh_constant[3 * 11] = 1e7f;
    for (const auto make : engines())
        for (const bool is_bright : {true, false}) {
            const auto e = ready(make, scene, is_bright ? bright : sound);
            e->begin(setup_with(gs::accumulator::fixed));
            auto plan = plan_for(0);
            plan.iteration = 5;
            e->step(plan);
            plan.iteration = 6;
            e->step(plan);
            const auto found = e->take_report().faults;
            CHECK(of(found, fault_kind::sum).count == (is_bright ? 2 : 0));
            if (is_bright) CHECK(of(found, fault_kind::sum).iteration == 5);
            CHECK(of(found, fault_kind::loss).count == 0);
            CHECK(is_finite(e->get_model()));
        }
}

TEST_CASE("a rate that would drive a parameter out of range moves nothing") {
    const gs::scene scene = small_scene();
    const gs::gaussians model = few(scene);
    for (const auto make : engines()) {
        const auto e = ready(make, scene, model);
        auto plan = plan_for(0);
        plan.iteration = 9;
        plan.rates = {};
        plan.rates[static_cast<std::size_t>(gs::parameter::opacity)] = infinity;
        e->step(plan);
        const auto found = e->take_report().faults;
        const fault_report& f = of(found, fault_kind::parameter);
        CHECK(f.count > 0);
        CHECK(f.iteration == 9);
        CHECK(f.parameter == gs::parameter::opacity);
        CHECK(f.gaussian < 30);
        const gs::gaussians after = e->get_model();
        CHECK(is_finite(after));
        CHECK(after.opacity == model.opacity);
    }
}

TEST_CASE("training says what it leaves out, once, and goes on") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = ready(make, scene, one_short_quaternion(scene, 5));
        std::vector<std::string> warnings;
        bool saved = false;
        const gs::train::train_events events{[](const gs::train::progress&) {},
                                             [&](int) { saved = is_finite(e->get_model()); }, [](int) {},
                                             [&](const std::string& line) { warnings.push_back(line); }};
        auto options = short_run(250);
        options.save_iterations = {250};
        const auto result = gs::train::train(*e, scene, options, events);
        REQUIRE(warnings.size() == 1);
        CHECK(warnings[0].find("the gradient of quaternion of Gaussian 5 is not finite") !=
              std::string::npos);
        CHECK(warnings[0].find("view ") != std::string::npos);
        CHECK(result.left_out_gradients >= 1);
        CHECK(saved);
    }
}

TEST_CASE("training warns once of sums that fixed point cannot hold") {
    const gs::scene scene = small_scene();
    gs::gaussians bright = few(scene);
    bright.sh_constant[3 * 11] = 1e7f;
    for (const auto make : engines()) {
        const auto e = ready(make, scene, bright);
        std::vector<std::string> warnings;
        const gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {},
                                             [&](const std::string& line) { warnings.push_back(line); }};
        auto options = short_run(20);
        options.gradient = gs::accumulator::fixed;
        const auto result = gs::train::train(*e, scene, options, events);
        CHECK(result.left_out_sums >= 1);
        REQUIRE(warnings.size() == 1);
        CHECK(warnings[0].find("exceeds the range of its fixed-point number") != std::string::npos);
        CHECK(warnings[0].find("view ") != std::string::npos);
    }
}

TEST_CASE("training ends where the loss is not finite, and names the view") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = ready(make, scene, few(scene));
        bool saved = false;
        const gs::train::train_events events{[](const gs::train::progress&) {}, [&](int) { saved = true; },
                                             [](int) {}};
        auto options = short_run(30);
        options.save_iterations = {20, 30};
        options.background.color = {0, infinity, 0};
        CHECK_THROWS_WITH_AS(gs::train::train(*e, scene, options, events),
                             doctest::Contains("iteration 1, view "), gs::error);
        CHECK_FALSE(saved);
    }
}

TEST_CASE("Gaussians that take no gradient are counted") {
    const gs::scene scene = small_scene();
    gs::gaussians model = few(scene);
    for (float& s : model.log_scale) s -= 2;
    // Just above 1/255 at their centers, below it half a pixel away: drawn, but hardly ever hit.
    model.opacity.assign(model.count(), gs::logit(1.0f / 254));
    for (const auto make : engines()) {
        const auto e = ready(make, scene, model);
        e->step(plan_for(0));
        gs::train::adaptive_config config;
        config.densify_grad_threshold = 1e9;
        config.least_opacity = 0;
        const auto counted = [&] { return densify_once(*e, config, 100); };
        const std::uint64_t first = counted();
        CHECK(first > 0);
        CHECK(first <= 30);
        CHECK(counted() == 0);  // no step since
    }
}
