// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "device/cpu/cpu.hpp"
#include "engines.hpp"
#include "optimize/trained_parameters.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

using enum gs::train::moment_precision;

namespace {

/// A run with all SH degrees, growth, pruned SH coefficients and resets of opacities.
gs::gaussians trained(make_engine make, const gs::scene& scene, const gs::train::parameter_storage& how) {
    gs::train::train_options o;
    o.schedule.iterations = 160;
    o.schedule.sh_degree_interval = 20;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 20;
    adaptive.densification_interval = 20;
    adaptive.densify_until_iter = 120;
    adaptive.opacity_reset_interval = 50;
    adaptive.prune_share = 0.2;
    o.max_cap = 1500;
    o.gradient = gs::accumulator::fixed;
    o.storage = how;
    const auto engine = make();
    engine->set_views(scene.train, scene.test, 1);
    engine->set_model(gs::from_points(scene.points, 3, 500, 1));
    gs::train::train(*engine, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
    return engine->get_model();
}

}  // namespace

TEST_CASE("storage: the memory of a Gaussian by precision and by the SH degrees in host memory") {
    const auto bytes = [](int sh_degree, gs::train::moment_precision precision, int first_on_host) {
        return gs::train::bytes_per_gaussian(sh_degree, {precision, first_on_host});
    };
    CHECK(bytes(3, full, 4).on_device == 708);
    CHECK(bytes(3, full, 4).on_host == 0);
    CHECK(bytes(3, full, 3).on_device == 708 - 21 * 12 + 68);  // with a cache for an eighth
    CHECK(bytes(3, full, 3).on_host == 21 * 12);
    CHECK(bytes(3, compact, 4).on_device == 348);
    CHECK(bytes(3, compact, 1).on_device == 108 + 30);
    CHECK(bytes(3, compact, 1).on_host == 240);
    CHECK(bytes(1, compact, 2).on_host == 0);
    CHECK(bytes(0, full, 1).on_device == 14 * 12);
}

TEST_CASE("storage: training with SH coefficients in host memory gives the same bits") {
    const gs::scene scene = small_scene("synthetic:spheres,gloss=0.6", 32);
    for (const auto make : engines())
        for (const auto precision : {full, compact}) {
            const gs::gaussians on_device = trained(make, scene, {precision, 4});
            CHECK(std::ranges::any_of(on_device.sh_rest, [](float x) { return x != 0; }));
            CHECK(on_device.count() != 500);
            for (const int first : {3, 1}) {
                CAPTURE(first);
                const gs::gaussians on_host = trained(make, scene, {precision, first});
                CHECK(on_host.mean == on_device.mean);
                CHECK(on_host.sh_rest == on_device.sh_rest);
                CHECK(on_host.opacity == on_device.opacity);
            }
        }
}

TEST_CASE("storage: parameters keep their values when they move, and lose moments of another precision") {
    gs::device::cpu device;
    gs::scene scene = small_scene();
    gs::gaussians model = gs::from_points(scene.points, 3, 100, 1);
    for (std::size_t i = 0; i < model.sh_rest.size(); ++i) model.sh_rest[i] = static_cast<float>(i);
    gs::train::trained_parameters<gs::device::cpu> all;
    all.set_values(device, model);
    all.set_storage(device, {full, 4});
    CHECK(all.first[0].size() == 0);  // until a step needs them
    all.require_memory(device, model.count(), 3);
    CHECK(all.first[0].size() > 0);
    all.first[7].data()[5] = 42;
    all.set_storage(device, {full, 2});
    CHECK(all.first[7].data()[5] == 42);
    CHECK(all.values.download(device, model.count(), 3).sh_rest == model.sh_rest);
    CHECK(all.fits(model.count(), 3));
    all.set_storage(device, {compact, 3});
    CHECK(all.last_step.size() == 0);
    CHECK(all.values.download(device, model.count(), 3).sh_rest == model.sh_rest);
}

TEST_CASE("storage: a new model has no moments until a step, so that their memory follows the storage") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        if (make()->profile().shares_host_memory()) continue;  // it does not count device memory
        const auto bytes_after = [&](gs::train::parameter_storage how) {
            const auto e = make();
            e->set_views(scene.train, {});
            const std::size_t before = e->profile().used_device_bytes();
            e->set_model(gs::from_points(scene.points, 3, 3000, 1));
            const std::size_t of_values = e->profile().used_device_bytes() - before;
            CHECK(of_values < 3000 * 59 * sizeof(float) * 3 / 2);
            gs::train::training_setup setup;
            setup.storage = how;
            e->begin(setup);
            e->reserve();
            e->step({});
            return e->profile().used_device_bytes();
        };
        CHECK(bytes_after({compact, 4}) < bytes_after({full, 4}));
    }
}

TEST_CASE("storage: the forecast counts parameters in host memory apart") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto engine = make();
        engine->set_views(scene.train, scene.test, 0);
        engine->set_model(gs::from_points(scene.points, 3, 300, 1));
        gs::device::memory_forecast forecasts[2];
        for (const int on_host : {0, 1}) {
            auto setup = setup_with(gs::accumulator::native);
            setup.storage = {compact, on_host == 1 ? 1 : 4};
            engine->begin(setup);
            forecasts[on_host] = engine->profile().forecast(1000000, 3);
        }
        CHECK(forecasts[0].on_host == 0);
        CHECK(forecasts[1].on_host == 240000000);
        CHECK(forecasts[1].total() + forecasts[1].on_host == forecasts[0].total() + 30000000);
    }
}
