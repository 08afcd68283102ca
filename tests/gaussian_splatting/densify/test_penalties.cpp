// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "../training/engines.hpp"
#include "densify/penalties.hpp"
#include "device/cpu/cpu.hpp"
#include "model/opacity.hpp"
#include "training/initialize.hpp"

namespace {

using gs::train::lower_by_penalty;

/// One block of Gaussians with equal second moments, and the penalty of one step.
struct penalized {
    std::vector<float> opacity, log_scale, opacity_moment, scale_moment;
    std::vector<std::uint32_t> last_step = std::vector<std::uint32_t>(gs::block_length, 7);
    lower_by_penalty penalty{};

    penalized(float logit, float size, float moment)
        : opacity(gs::block_length, logit),
          log_scale(3 * gs::block_length, size),
          opacity_moment(gs::block_length, moment),
          scale_moment(3 * gs::block_length, moment) {
        penalty.values.opacity = opacity.data();
        penalty.values.log_scale = log_scale.data();
        penalty.moments.second.opacity = opacity_moment.data();
        penalty.moments.second.log_scale = scale_moment.data();
        penalty.last_step = last_step.data();
        penalty.step = 7;
        penalty.correction = 1;
        penalty.opacity_rate = 0.02f;
        penalty.scale_rate = 0.01f;
        penalty.opacity_gradient = 1e-6f;
        penalty.scale_gradient = 1e-6f;
    }
};

}  // namespace

TEST_CASE("penalties: a value moves by the ratio of the gradient to the root of its second moment") {
    penalized p(0, std::log(2.0f), 1e-8f);  // a root of 1e-4
    p.penalty(5);
    CHECK(p.opacity[5] == doctest::Approx(-0.02 * 1e-6 * 0.25 / 1e-4));
    for (std::size_t k = 0; k < 3; ++k)
        CHECK(p.log_scale[gs::aosoa_index(5, k, 3)] - std::log(2.0f) ==
              doctest::Approx(-0.01 * 1e-6 * 2 / 1e-4).epsilon(1e-2));
    CHECK(p.opacity[4] == 0);
    CHECK(p.opacity[6] == 0);
}

TEST_CASE("penalties: second moments have Adam's correction of bias, and decay in missed steps") {
    penalized p(0, 0, 1e-8f);
    p.penalty.correction = 4;
    p.penalty(5);
    CHECK(p.opacity[5] == doctest::Approx(-0.02 * 1e-6 * 0.25 / 2e-4));
    p.last_step[6] = 7 - 7;
    p.penalty.step = 1000;
    p.penalty.correction = 1;
    p.penalty(6);
    CHECK(p.opacity[6] == doctest::Approx(-0.02 * 1e-6 * 0.25 / (1e-4 * std::pow(0.999, 500))));
}

TEST_CASE("penalties: the weights are those of means over Gaussians and axes") {
    using cpu = gs::device::cpu;
    const gs::scene scene = small_scene();
    const gs::gaussians model = gs::from_points(scene.points, 0, 40, 1);
    cpu device;
    gs::train::trained_parameters<cpu> all;
    gs::gaussians moments = model;
    std::ranges::fill(moments.opacity, 1e-4f);
    std::ranges::fill(moments.log_scale, 1e-4f);
    all.values.upload(device, model);
    all.second.upload(device, moments);
    all.last_step.resize(40);
    std::fill_n(all.last_step.data(), 40, 9u);
    gs::train::step_context<cpu> step{{device, all, 40, {0, 40}, 0, nullptr, 0}, {}, {}};
    step.rates[static_cast<std::size_t>(gs::parameter::opacity)] = 0.5f;
    step.rates[static_cast<std::size_t>(gs::parameter::log_scale)] = 0.25f;
    gs::train::apply_penalties<cpu>({0.04, 0.06}, 2, 9, step);
    const gs::gaussians after = all.values.download(device, 40, 0);
    const double root = std::sqrt(1e-4 / (1 - std::pow(0.999, 9)));
    for (std::size_t i = 0; i < 40; ++i) {
        const double o = gs::sigmoid(static_cast<double>(model.opacity[i]));
        CHECK(after.opacity[i] - model.opacity[i] ==
              doctest::Approx(-0.5 * 0.04 / 40 * o * (1 - o) / root).epsilon(1e-2));
        const double size = std::exp(static_cast<double>(model.log_scale[3 * i]));
        CHECK(after.log_scale[3 * i] - model.log_scale[3 * i] ==
              doctest::Approx(-0.25 * 0.06 / (3 * 40 * 2) * size / root).epsilon(5e-2));
    }
}

TEST_CASE("penalties: a value moves by at most a tenth of its learning rate") {
    for (const float moment : {0.0f, 1e-45f, 1e-30f}) {
        penalized p(0, 80, moment);
        p.penalty(0);
        CHECK(p.opacity[0] == doctest::Approx(-0.002f));
        CHECK(p.log_scale[0] == doctest::Approx(80 - 0.001f));
    }
}

TEST_CASE("penalties: opaque and transparent Gaussians stay finite") {
    for (const float logit : {-1e30f, -88.0f, 88.0f, 1e30f}) {
        penalized p(logit, -1e30f, 0);
        p.penalty(0);
        CHECK(std::isfinite(p.opacity[0]));
        CHECK(std::isfinite(p.log_scale[0]));
    }
}

TEST_CASE("penalties: a learning rate that would drive a value out of range changes nothing") {
    penalized p(0, 1, 0);
    p.penalty.opacity_rate = p.penalty.scale_rate = std::numeric_limits<float>::infinity();
    p.penalty(0);
    CHECK(p.opacity[0] == 0);
    CHECK(p.log_scale[0] == 1);
}

TEST_CASE("penalties: without a weight of scales, scales stay") {
    penalized p(0, 1, 0);
    p.penalty.scale_gradient = 0;
    p.penalty(0);
    CHECK(p.opacity[0] < 0);
    CHECK(p.log_scale == std::vector<float>(3 * gs::block_length, 1));
}

TEST_CASE("penalties: a step whose tile lists exceed the capacity changes nothing") {
    penalized p(0, 1, 0);
    const std::uint64_t required = 11;
    p.penalty.capacity = {&required, 10};
    p.penalty(0);
    CHECK(p.opacity[0] == 0);
    CHECK(p.log_scale[0] == 1);
}

TEST_CASE("penalties: training with adaptive lowers the opacities of Gaussians that no view shows") {
    const gs::scene scene = small_scene();
    gs::gaussians model = gs::from_points(scene.points, 0, 200, 1);
    for (std::size_t i = 100; i < 200; ++i) model.opacity[i] = gs::logit(0.001f);  // too faint to be drawn
    for (const auto make : engines())
        for (const double weight : {0.0, 0.01}) {
            const auto e = make();
            auto setup = setup_with(gs::accumulator::fixed);
            setup.densification.of<gs::train::adaptive_config>().opacity_penalty = weight;
            e->set_views(scene.train, {});
            e->set_model(model);
            e->begin(setup);
            e->reserve();
            auto plan = plan_for(0);
            for (plan.iteration = 1; plan.iteration <= 10; ++plan.iteration) {
                plan.view = static_cast<std::size_t>(plan.iteration) % scene.train.size();
                e->step(plan);
            }
            const gs::gaussians after = e->get_model();
            for (std::size_t i = 100; i < 200; ++i) {
                const float moved =
                    weight > 0 ? 10 * 0.1f * plan.rates[static_cast<std::size_t>(gs::parameter::opacity)]
                               : 0.0f;
                CHECK(after.opacity[i] == doctest::Approx(model.opacity[i] - moved));
            }
        }
}
