// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "../training/engines.hpp"
#include "core/error.hpp"
#include "device/cpu/cpu.hpp"
#include "lab/accumulator_set.hpp"
#include "render/gradients/gradient_sums.hpp"
#include "train/engines.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using gs::accumulator;

/// With growth, and colors that depend on the direction.
gs::gaussians trained(gs::train::engine& e, const gs::scene& scene, accumulator how) {
    gs::train::train_options o;
    o.schedule.iterations = 120;
    o.schedule.sh_degree_interval = 40;
    o.densification.of<gs::train::adaptive_config>().densify_from_iter = 40;
    o.densification.of<gs::train::adaptive_config>().densify_until_iter = 100;
    o.densification.of<gs::train::adaptive_config>().densification_interval = 30;
    o.densification.of<gs::train::adaptive_config>().densify_grad_threshold = 1e-5;
    o.max_cap = 4000;
    o.gradient = how;
    e.set_views(scene.train, {}, o.schedule.num_downscales);
    e.set_model(gs::from_points(scene.points, o.schedule.sh_degree, 500, 1));
    gs::train::train(e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
    return e.get_model();
}

bool are_the_same(const gs::gaussians& a, const gs::gaussians& b) {
    return a.mean == b.mean && a.log_scale == b.log_scale && a.quaternion == b.quaternion &&
           a.opacity == b.opacity && a.sh_constant == b.sh_constant && a.sh_rest == b.sh_rest;
}

/// Starts a run with this accumulator.
void begin(gs::train::engine& e, accumulator how) {
    gs::train::training_setup setup;
    setup.facts.gradient = how;
    e.begin(setup);
    e.reserve();
}

}  // namespace

TEST_CASE("lab: fixed, binned and exact sums make training repeatable") {
    const gs::scene scene = small_scene();
    for (const accumulator how : {gs::lab::fixed, gs::lab::binned, gs::lab::exact}) {
        CAPTURE(gs::lab::name_of(how));
        const gs::gaussians first = trained(*gs::lab::make_cpu_engine(), scene, how);
        CHECK(first.count() > 500);
        CHECK(are_the_same(trained(*gs::lab::make_cpu_engine(), scene, how), first));
    }
}

TEST_CASE("lab: fixed sums train what the trainer's engine trains") {
    const gs::scene scene = small_scene();
    CHECK(are_the_same(trained(*gs::lab::make_cpu_engine(), scene, gs::lab::fixed),
                       trained(*gs::train::make_cpu_engine(), scene, accumulator::fixed)));
}

TEST_CASE("lab: only the trainer's accumulators train a sky, the others refuse") {
    const gs::scene scene = small_scene();
    gs::gaussians model = gs::from_points(scene.points, 0, 500, 1);
    model.sky.assign(gs::sky_width, 0.0f);
    const auto e = gs::lab::make_cpu_engine();
    e->set_views(scene.train, {}, 0);
    e->set_model(model);
    for (const auto& [name, how] : gs::lab::variants) {
        CAPTURE(name);
        begin(*e, how);
        if (gs::lab::lab_accumulators::supports_background_image(how))
            CHECK_NOTHROW(e->step(plan_for(0)));
        else
            CHECK_THROWS_WITH_AS(e->step(plan_for(0)), doctest::Contains("learned background"), gs::error);
    }
}

TEST_CASE("lab: the trainer's engine refuses an accumulator that it does not have") {
    const gs::scene scene = small_scene();
    const auto e = gs::train::make_cpu_engine();
    e->set_views(scene.train, {}, 0);
    e->set_model(gs::from_points(scene.points, 0, 500, 1));
    begin(*e, gs::lab::exact);
    CHECK_THROWS_WITH_AS(e->step(plan_for(0)), doctest::Contains("2 accumulators"), gs::error);
}

TEST_CASE("lab: exact sums take images of any number of patches") {
    using device = gs::device::cpu;
    device d;
    gs::raster::gradient_sums<device, float> sums(d);
    gs::lab::lab_accumulators::with_kernel<float, gs::raster::cut_for<device::warp>>(
        gs::lab::exact, [&](auto kernel) {
            CHECK_NOTHROW(sums.begin(kernel, 1, 1, (std::size_t{1} << gs::raster::fixed_log_warps) + 1));
        });
}
