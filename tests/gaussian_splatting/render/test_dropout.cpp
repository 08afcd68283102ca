// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "../training/engines.hpp"
#include "core/random.hpp"
#include "device/cpu/cpu.hpp"
#include "model/opacity.hpp"
#include "optimize/trained_parameters.hpp"
#include "render/renderer.hpp"
#include "training/initialize.hpp"

namespace {

using gs::raster::dropout;

/// The model on black, without the Gaussians that `dropped` leaves out.
std::vector<float> rendered(const gs::gaussians& model, const gs::camera& camera, const dropout& dropped) {
    gs::device::cpu device;
    gs::train::trained_parameters<gs::device::cpu> all;
    all.values.upload(device, model);
    gs::raster::renderer<gs::device::cpu, float> renderer(device);
    renderer.reserve_instances(1u << 20);
    renderer.list(all.values.read(), model.count(), camera, 0, dropped);
    renderer.blend({0, 0, 0});
    const std::size_t pixels =
        static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    return {renderer.render(), renderer.render() + 3 * pixels};
}

}  // namespace

TEST_CASE("dropout: leaves out the share, by independent choices in each step") {
    constexpr std::uint32_t count = 100000;
    for (const double share : {0.0, 0.1, 0.5, 0.9})
        for (const std::uint32_t key : {0u, 1u, 0x80000000u}) {
            const dropout first(share, key), second(share, key + 1);
            int once = 0, twice = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                once += first.leaves_out(i) ? 1 : 0;
                twice += first.leaves_out(i) && second.leaves_out(i) ? 1 : 0;
            }
            const auto is_close = [&](int found, double expected) {
                const double deviation = std::sqrt(count * expected * (1 - expected));
                return std::abs(found - count * expected) <= 5 * deviation + 2;
            };
            CHECK_MESSAGE(is_close(once, share), once << " of " << count << " for " << share);
            CHECK_MESSAGE(is_close(twice, share * share), twice << " in both steps for " << share);
        }
}

TEST_CASE("dropout: the render is that of the other Gaussians, with opacities that gain what is missing") {
    const gs::scene scene = small_scene();
    gs::gaussians model = gs::from_points(scene.points, 0, 300, 1);
    std::ranges::fill(model.opacity, gs::logit(0.6f));
    const dropout dropped(0.25, 12345);
    gs::gaussians rest = model;
    int left_out = 0;
    for (std::uint32_t i = 0; i < 300; ++i) {
        rest.opacity[i] = gs::logit(dropped.leaves_out(i) ? 1e-6f : 0.6f / 0.75f);
        left_out += dropped.leaves_out(i) ? 1 : 0;
    }
    CHECK(left_out > 40);
    const gs::camera& camera = scene.train[0].camera;
    const auto found = rendered(model, camera, dropped), expected = rendered(rest, camera, {}),
               all = rendered(model, camera, {});
    const auto largest_difference = [&](const std::vector<float>& other) {
        float largest = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            largest = std::max(largest, std::abs(found[i] - other[i]));
        return largest;
    };
    CHECK(largest_difference(all) > 0.01f);
    CHECK(largest_difference(expected) < 1e-5f);
}

TEST_CASE("dropout: a step changes only Gaussians that it draws, the same ones on every device") {
    const gs::scene scene = small_scene();
    gs::gaussians model = gs::from_points(scene.points, 0, 300, 1);
    // Brighter than the photos, so that no pixel has a gradient of zero.
    std::ranges::fill(model.sh_constant, 4.0f);
    for (const auto make : engines()) {
        const auto changed_by = [&](double share) {
            const auto e = make();
            e->set_views(scene.train, scene.test);
            e->set_model(model);
            auto setup = setup_with(gs::accumulator::fixed);
            setup.facts.seed = 7;
            setup.densification.of<gs::train::adaptive_config>().opacity_penalty = 0;
            setup.dropout = share;
            e->begin(setup);
            e->reserve();
            e->step(plan_for(0));
            const gs::gaussians after = e->get_model();
            std::vector<bool> changed(300);
            for (std::size_t i = 0; i < 300; ++i)
                changed[i] = after.sh_constant[3 * i] != model.sh_constant[3 * i];
            return changed;
        };
        const std::vector<bool> all = changed_by(0), some = changed_by(0.5);
        gs::train::counter_random random(7, 1, 0);
        const dropout dropped(0.5, static_cast<std::uint32_t>(random.below(std::uint64_t{1} << 32)));
        int drawn = 0;
        for (std::uint32_t i = 0; i < 300; ++i) {
            if (dropped.leaves_out(i)) CHECK_FALSE(some[i]);
            if (!dropped.leaves_out(i) && all[i]) {
                CHECK(some[i]);
                ++drawn;
            }
        }
        CHECK(drawn > 50);
    }
}

TEST_CASE("dropout: opaque Gaussians keep finite parameters when their opacities gain") {
    const gs::scene scene = small_scene();
    gs::gaussians model = gs::from_points(scene.points, 0, 300, 1);
    for (const float logit : {-1e30f, 5.0f, 88.0f, 1e30f}) {
        std::ranges::fill(model.opacity, logit);
        for (const auto make : engines()) {
            const auto e = make();
            e->set_views(scene.train, scene.test);
            e->set_model(model);
            auto setup = setup_with(gs::accumulator::native);
            setup.dropout = 0.9;
            e->begin(setup);
            e->reserve();
            e->step(plan_for(0));
            const gs::gaussians after = e->get_model();
            const auto is_finite = [](float x) { return std::isfinite(x); };
            CHECK(std::ranges::all_of(after.opacity, is_finite));
            CHECK(std::ranges::all_of(after.mean, is_finite));
            CHECK(std::ranges::all_of(after.log_scale, is_finite));
        }
    }
}
