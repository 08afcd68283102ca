// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/sky/sky.hpp"
#include "random_render.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

using gs_test::random_render;

}  // namespace

TEST_CASE("a sky is drawn by direction, and its gradients are those of central differences") {
    gs::device::cpu device;
    using warp = gs::device::cpu::warp;
    std::mt19937 random(3);
    for (const auto& [width, height, world] : {std::tuple{1, 1, "spheres"},
                                               {37, 19, "spheres"},
                                               {64, 8, "spheres"},
                                               {37, 19, "spheres,fisheye=150"},
                                               {38, 19, "spheres,panorama=1"}}) {
        CAPTURE(width);
        CAPTURE(world);
        const auto pixels = static_cast<std::size_t>(width * height);
        gs::camera camera = small_scene((std::string("synthetic:") + world).c_str(), 32).train[7].camera;
        camera.width = width;
        camera.height = height;
        camera.cx = 0.4 * width;
        std::vector<float> coefficients = random_render(random, gs::sky_width);
        const auto weights = random_render(random, 3 * pixels), through = random_render(random, pixels);
        gs::features::sky<gs::device::cpu> sky(device);
        CHECK(sky.draw(camera) == nullptr);
        // The gradient of the sum of weights and of the transmitted sky.
        const auto loss = [&] {
            sky.set(coefficients);
            const float* planes = sky.draw(camera);
            double sum = 0;
            for (std::size_t i = 0; i < 3 * pixels; ++i)
                sum += static_cast<double>(weights[i] * through[i % pixels] * planes[i]);
            return sum;
        };
        gs::train::adam_parameters<gs::device::cpu, gs::sky_width> numbers(device);
        const auto sums = numbers.sums(sky_patch<warp, gs::lens_model::pinhole>::count(width, height));
        gs::raster::with_lens(camera.lens(), [&]<gs::lens_model Lens> {
            device.for_each_warp(
                sums.warps,
                sky_backward<warp, Lens>{gs::raster::for_device<warpagg::value_t<warp, float>>(camera),
                                         through.data(), weights.data(), sums, 0});
        });
        for (const unsigned k : {0u, 4u, 20u, 47u}) {
            double by = 0;
            for (std::size_t part = 0; part < sums.warps; ++part) by += static_cast<double>(*sums(k, part));
            const float before = coefficients[k];
            coefficients[k] = before + 0.5f;
            const double more = loss();
            coefficients[k] = before - 0.5f;
            const double error = std::abs(more - loss() - by);
            CHECK(error < 1e-5 * static_cast<double>(pixels));
            coefficients[k] = before;
        }
        const double first = loss();
        for (int i = 0; i < 5; ++i) sky.learn(camera, through.data(), weights.data(), 0.01f, {});
        const auto learnt = sky.get();
        for (std::size_t k = 0; k < 3; ++k)  // the constant's gradient is positive: steps are of the rate
            CHECK(learnt[k] == doctest::Approx(coefficients[k] - 0.05f).epsilon(1e-3));
        coefficients = learnt;
        CHECK(loss() < first);
    }
}

TEST_CASE("long: sky: a background is learned where no surface is") {
    const gs::scene scene = small_scene("synthetic:spheres,sky=0.9", 48);
    gs::gaussians points = gs::from_points(scene.points, 0, 3000, 1);
    for (const auto make : engines()) {
        const auto psnr_with = [&](const std::vector<float>& sky) {
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 400;
            o.schedule.sh_degree = 0;
            o.max_cap = 4000;
            gs::gaussians model = points;
            model.sky = sky;
            e->set_views(scene.train, scene.test, o.schedule.num_downscales);
            e->set_model(model);
            gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
            const double psnr = gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr();
            model = e->get_model();
            CHECK(model.sky.size() == sky.size());
            if (!sky.empty()) CHECK(model.sky != sky);
            e->set_model(model);
            CHECK(gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr() ==
                  doctest::Approx(psnr).epsilon(1e-6));
            return psnr;
        };
        CHECK(psnr_with(std::vector<float>(gs::sky_width, 0.0f)) > psnr_with({}) + 3);
    }
}
