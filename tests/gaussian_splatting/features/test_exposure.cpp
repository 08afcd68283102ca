// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"
#include "evaluation/fit_exposure.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/exposure/exposures.hpp"
#include "features/exposure/held_out_exposures.hpp"
#include "features/resolve.hpp"
#include "random_render.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

using gs_test::random_render;

}  // namespace

TEST_CASE("gradients by the image and by the exposure are those of central differences") {
    using device_type = gs::device::cpu;
    device_type device;
    std::mt19937 random(1);
    for (const image_part part : {image_part{1, 1}, {31, 1}, {35, 20}}) {
        const std::size_t pixels = part.pixels();
        CAPTURE(pixels);
        const auto render = random_render(random, 3 * pixels), weights = random_render(random, 3 * pixels);
        // Of the sum of weights and exposed values, by an exposure that was learnt.
        gs::features::exposures<device_type> exposures(device);
        exposures.set(gs::features::flattened({identity_exposure, identity_exposure}));
        const auto show = [&](const std::vector<float>& of) {
            const float* shown = exposures.show(1, of.data(), pixels);
            return std::vector<float>(shown, shown + 3 * pixels);
        };
        CHECK(show(render) == render);
        for (int i = 0; i < 30; ++i) exposures.learn(1, render.data(), weights.data(), part, 0.02f, {});
        const auto values = gs::features::exposures_from(exposures.get());
        CHECK(values[0] == identity_exposure);
        for (const float x : {values[1][0], values[1][5], values[1][10]})
            CHECK(x == doctest::Approx(0.4).epsilon(
                           1e-3));  // each step is of the rate: all gradients are positive
        const auto loss = [&](const std::vector<float>& of) {
            double sum = 0;
            const auto shown = show(of);
            for (std::size_t i = 0; i < shown.size(); ++i)
                sum += static_cast<double>(weights[i]) * static_cast<double>(shown[i]);
            return sum;
        };
        const float* by = exposures.learn(1, render.data(), weights.data(), part, 0, {});
        for (const std::size_t i : {std::size_t{0}, pixels - 1, 2 * pixels}) {
            auto more = render;
            more[i] += 0.5f;
            CHECK((loss(more) - loss(render)) * 2 ==
                  doctest::Approx(static_cast<double>(by[i])).epsilon(1e-4));
        }
        exposures.normalize();
        const auto centered = gs::features::exposures_from(exposures.get());
        for (std::size_t k = 0; k < 12; ++k)
            CHECK(0.5f * (centered[0][k] + centered[1][k]) ==
                  doctest::Approx(k % 5 == 0 ? 1 : 0).epsilon(1e-6));
        CHECK(centered[1][0] - centered[0][0] == doctest::Approx(values[1][0] - values[0][0]).epsilon(1e-6));
    }
}

TEST_CASE("a step without room, or whose gradient is not finite, leaves the exposure") {
    gs::device::cpu device;
    gs::features::exposures<gs::device::cpu> exposures(device);
    exposures.set(gs::features::flattened({identity_exposure}));
    const auto before = exposures.get();
    const std::vector<float> render(3, 0.5f), nothing(3, std::nanf(""));
    const std::uint64_t required = 2;
    exposures.learn(0, render.data(), render.data(), {1, 1}, 0.1f, {&required, 1});
    CHECK(exposures.get() == before);
    exposures.learn(0, render.data(), nothing.data(), {1, 1}, 0.1f, {});
    CHECK(exposures.get() == before);
    exposures.learn(0, render.data(), render.data(), {1, 1}, 0.1f, {&required, 2});
    CHECK(exposures.get() != before);
}

TEST_CASE("long: exposure: photos of different exposures are fitted, and their mean stays") {
    const gs::scene scene = small_scene("synthetic:spheres,exposure=0.4", 32);
    std::array<double, 2> psnr{};
    for (const auto make : engines())
        for (const bool exposes : {false, true}) {
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 400;
            o.schedule.sh_degree = 0;
            o.max_cap = 4000;
            if (exposes)
                o.features = feature_set(
                    {{"exposure", true, "", flattened(std::vector(scene.train.size(), identity_exposure))}});
            e->set_views(scene.train, {}, o.schedule.num_downscales);
            e->set_model(gs::from_points(scene.points, 0, 3000, 1));
            gs::train::train_events events{[&](const gs::train::progress& p) { psnr[exposes] = p.psnr; },
                                           [](int) {}, [](int) {}};
            gs::train::train(*e, scene, o, events);
            const auto learned = exposures_from(e->feature("exposure").values());
            CHECK(learned.size() == scene.train.size());
            if (!exposes) {
                CHECK(learned == std::vector(scene.train.size(), identity_exposure));
                continue;
            }
            CHECK(psnr[1] > psnr[0] + 3);
            double mean = 0, square = 0;
            for (const auto& x : learned) {
                mean += static_cast<double>(x[5]);
                square += static_cast<double>(x[5] * x[5]);
            }
            mean /= static_cast<double>(scene.train.size());
            CHECK(mean == doctest::Approx(1).epsilon(1e-4));
            CHECK(std::sqrt(square / static_cast<double>(scene.train.size()) - mean * mean) > 0.1);
        }
}

TEST_CASE("test photos are exposed as their neighbors, if training photos are") {
    gs::scene scene;
    for (const char* name : {"e", "a", "c", "g"}) scene.train.emplace_back().name = name;
    for (const char* name : {"0", "b", "d", "z"}) scene.test.emplace_back().name = name;
    const auto gain = [](float x) { return exposure{x, 0, 0, 0, 0, x, 0, 0, 0, 0, x, 0}; };
    const std::vector walk{gain(1.2f), gain(0.8f), gain(1), gain(1.4f)};
    CHECK(held_out_exposures(scene, walk) ==
          std::vector{gain(0.8f), gain(0.5f * (0.8f + 1)), gain(0.5f * (1 + 1.2f)), gain(1.4f)});
    const std::vector jumps{gain(0.6f), gain(0.8f), gain(1.4f), gain(1.2f)};
    CHECK(held_out_exposures(scene, jumps) == std::vector(4, identity_exposure));
}

TEST_CASE("what test views are shown with is what they are measured with") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        e->set_model(gs::from_points(scene.points, 0, 1000, 1));
        std::vector<float> plain, darker;
        const double before = e->measure(1, {}, &plain).psnr();
        auto half = std::vector(scene.test.size(), identity_exposure);
        half[1] = {0.5f, 0, 0, 0.1f, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0};
        e->feature("exposure").set_held_out_values(flattened(half));
        CHECK(e->measure(1, {}, &darker).psnr() < before);
        for (std::size_t i = 0; i < plain.size(); ++i)
            CHECK(darker[i] == doctest::Approx(0.5f * plain[i] + (i < plain.size() / 3 ? 0.1f : 0.0f)));
        CHECK(e->measure(0, {}, &darker).psnr() != before);
        e->feature("exposure").set_held_out_values({});
        CHECK(e->measure(1, {}).psnr() == before);
    }
}

TEST_CASE("a fit finds what an exposure did, on pixels that it is not measured by") {
    std::mt19937 random(2);
    constexpr int width = 20, height = 9;
    const auto render = random_render(random, 3 * width * height);
    gs::image photo{width, height, std::vector<std::uint8_t>(4 * width * height, 255)};
    for (std::size_t i = 0; i < render.size(); ++i)
        photo.rgba[4 * (i % (width * height)) + i / (width * height)] =
            static_cast<std::uint8_t>(std::lround(255 * (0.6f * render[i] + 0.1f)));
    const auto psnr = [&](const gs::image& of) { return *gs::evaluate::psnr_after_fit(render, of, {}); };
    const double by_rounding = -20 * std::log10(std::sqrt(1.0 / 12) / 255);
    CHECK(psnr(photo) == doctest::Approx(by_rounding).epsilon(0.02));
    // Half of what either half has is spoilt; a mask leaves that out.
    gs::image spoilt = photo, masked = photo;
    for (std::size_t i = 0; i < width * height; i += 2) {
        for (std::size_t c = 0; c < 3; ++c) spoilt.rgba[4 * i + c] = 128;
        masked.mask_pixel(i);
    }
    CHECK(psnr(spoilt) < 20);
    CHECK(psnr(masked) == doctest::Approx(by_rounding).epsilon(0.02));
    for (std::size_t i = 0; i < width * height; ++i)
        if (i % width >= width / 2) masked.mask_pixel(i);
    CHECK_FALSE(gs::evaluate::psnr_after_fit(render, masked, {}));
    // Without a left half nothing changes.
    CHECK(*gs::evaluate::psnr_after_fit({0.5f, 0.5f, 0.5f}, gs::image{1, 1, {153, 128, 128, 255}}, {}) ==
          doctest::Approx(-10 * std::log10((0.01 + 2 * std::pow(0.5 / 255, 2)) / 3)).epsilon(1e-4));
}
