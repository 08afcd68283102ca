// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "engines.hpp"
#include "scene/downsample.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using gs::gaussians;

bool same(const gaussians& a, const gaussians& b) {
    return a.mean == b.mean && a.log_scale == b.log_scale && a.quaternion == b.quaternion &&
           a.opacity == b.opacity && a.sh_constant == b.sh_constant && a.sh_rest == b.sh_rest;
}

double psnr_between(const std::vector<float>& a, const std::vector<float>& b) {
    double square = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        square += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
    return -10 * std::log10(square / static_cast<double>(a.size()) + 1e-20);
}

/// Values of the feature "depth" with the same scale for every training view.
std::vector<float> depth_fits(const gs::scene& scene, float scale) {
    std::vector<float> values;
    for (std::size_t v = 0; v < scene.train.size(); ++v) values.insert(values.end(), {scale, 0.0f});
    return values;
}

}  // namespace

TEST_CASE("a model comes back from the device as it went, at every degree") {
    const gs::scene scene = small_scene();
    for (const auto make : engines())
        for (int degree = 0; degree <= 3; ++degree) {
            gaussians model = gs::from_points(scene.points, degree, 500, 1);
            for (std::size_t i = 0; i < model.sh_rest.size(); ++i) model.sh_rest[i] = static_cast<float>(i);
            const auto e = make();
            e->set_model(model);
            CHECK(e->count() == 500);
            CHECK(same(e->get_model(), model));
        }
}

TEST_CASE("training brings the held-out views near the photos") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = make();
        gs::train::train_options o;
        e->set_views(scene.train, scene.test, o.schedule.num_downscales);
        e->set_model(gs::from_points(scene.points, 1, 3000, 1));
        const double before = e->measure(0, {}).psnr();
        o.schedule.iterations = 300;
        o.schedule.sh_degree = 1;
        o.schedule.sh_degree_interval = 100;
        o.max_cap = 4000;
        int reports = 0;
        gs::train::train_events events{[&](const gs::train::progress& p) {
                                           ++reports;
                                           CHECK(std::isfinite(p.loss));
                                       },
                                       [](int) {}, [](int) {}};
        const auto result = gs::train::train(*e, scene, o, events);
        CHECK(reports == 3);
        CHECK(result.skipped_steps == 0);
        CHECK(before < 22);
        CHECK(e->measure(0, {}).psnr() > before + 4);
        CHECK(e->measure(0, {}).ssim > 0.9);
    }
}

TEST_CASE("what it measures is what it draws") {
    const gs::scene scene = small_scene("synthetic:alpha");
    REQUIRE(scene.has_alpha);
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        e->set_model(gs::from_points(scene.points, 0, 1000, 1));
        const std::array<float, 3> white{1, 1, 1};
        const auto& view = scene.test[1];
        auto render = e->render(view.camera, white);
        std::vector<float> measured;
        const auto quality = e->measure(1, white, &measured);
        CHECK(measured == render);
        for (float& x : render) x = std::clamp(x, 0.0f, 1.0f);
        CHECK(quality.psnr() ==
              doctest::Approx(psnr_between(render, gs::over_background(view.pixels, white.data())))
                  .epsilon(1e-4));
    }
}

TEST_CASE("a step learns from photos as small as it is told to") {
    const gs::scene scene = small_scene("synthetic:alpha");
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test, 2);
        e->set_model(gs::from_points(scene.points, 0, 1000, 1));
        auto plan = plan_for(3);
        plan.rates = {};
        plan.background = {1, 1, 1};
        for (const int downscales : {2, 0, 1}) {
            CAPTURE(downscales);
            e->reserve(downscales);
            e->take_report().loss;
            e->step(plan);
            const gs::view small = gs::downsampled(scene.train[3], 1 << downscales);
            REQUIRE(small.camera.width == 48 >> downscales);
            CHECK(e->take_report().loss.psnr() ==
                  doctest::Approx(psnr_between(e->render(small.camera, plan.background),
                                               gs::over_background(small.pixels, plan.background.data())))
                      .epsilon(1e-4));
        }
        e->set_views(scene.train, scene.test);
        e->take_report().loss;
        e->step(plan);
        CHECK(
            e->take_report().loss.psnr() ==
            doctest::Approx(psnr_between(e->render(scene.train[3].camera, plan.background),
                                         gs::over_background(scene.train[3].pixels, plan.background.data())))
                .epsilon(1e-4));
    }
}

TEST_CASE("gradients of centers, in halves of the image, are alike on photos of any size") {
    // As many grow at a threshold on photos of 64 pixels as on photos of 32, to a quarter of them.
    gs::scene scene = small_scene("synthetic:spheres", 64);
    for (const auto make : engines()) {
        std::array<double, 2> grown{};
        for (const int downscales : {0, 1}) {
            const auto e = make();
            e->set_views(scene.train, {}, 1);
            e->set_model(gs::from_points(scene.points, 0, 300, 1));
            e->reserve(downscales);
            auto plan = plan_for(0);
            plan.rates = {};
            for (plan.view = 0; plan.view < scene.train.size(); ++plan.view) e->step(plan);
            densify_once(*e, {.densify_grad_threshold = 1e-3}, 1000);
            grown[static_cast<std::size_t>(downscales)] = static_cast<double>(e->count()) - 300;
        }
        CAPTURE(grown[0]);
        CHECK(grown[0] > 50);
        CHECK(grown[0] < 250);
        CHECK(grown[1] == doctest::Approx(grown[0]).epsilon(0.25));
    }
}

TEST_CASE("a level that was not downsampled is an error") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, {}, 1);
        e->reserve(1);
        CHECK_THROWS_WITH_AS(e->reserve(2),
                             "the training views have 2 sizes, so they cannot be halved 2 times", gs::error);
    }
}

TEST_CASE("colors that depend on direction stay as they are when they are not to learn") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        gs::gaussians model = gs::from_points(scene.points, 2, 1000, 1);
        std::ranges::fill(model.sh_rest, 0.01f);
        e->set_model(model);
        e->reserve();
        auto plan = plan_for(0);
        plan.sh_degree = 2;
        plan.updates_sh = false;
        e->step(plan);
        const gs::gaussians without = e->get_model();
        CHECK(without.sh_rest == model.sh_rest);
        CHECK(without.sh_constant != model.sh_constant);
        CHECK(without.mean != model.mean);
        const double psnr = e->take_report().loss.psnr();
        e->set_model(model);
        plan.updates_sh = true;
        e->step(plan);
        CHECK(e->get_model().sh_rest != model.sh_rest);
        CHECK(e->take_report().loss.psnr() == doctest::Approx(psnr).epsilon(1e-6));  // both drew them
    }
}

TEST_CASE("a Gaussian that a view does not see keeps its bits, whatever its momentum") {
    const gs::scene scene = small_scene();
    gaussians model = gs::from_points(scene.points, 1, 1000, 1);
    std::ranges::fill(model.opacity, 6.0f);                             // those in front hide others
    for (float& c : model.sh_constant) c = std::clamp(c, -1.5f, 1.5f);  // black has no gradient to see it by
    const auto changed = [&](const gaussians& a, const gaussians& b) {
        const auto part = [](const std::vector<float>& x, const std::vector<float>& y, std::size_t i,
                             std::size_t width) {
            const auto at = static_cast<std::ptrdiff_t>(i * width), n = static_cast<std::ptrdiff_t>(width);
            return !std::equal(x.begin() + at, x.begin() + at + n, y.begin() + at);
        };
        std::vector<bool> is(model.count());
        for (std::size_t i = 0; i < is.size(); ++i)
            is[i] = part(a.mean, b.mean, i, 3) || part(a.log_scale, b.log_scale, i, 3) ||
                    part(a.quaternion, b.quaternion, i, 4) || part(a.opacity, b.opacity, i, 1) ||
                    part(a.sh_constant, b.sh_constant, i, 3) || part(a.sh_rest, b.sh_rest, i, 9);
        return is;
    };
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        const auto plan = [](std::size_t view, float rate) {
            auto p = plan_for(view);
            p.sh_degree = 1;
            p.rates.fill(rate);
            return p;
        };
        // From no momentum, a step moves those that its view sees.
        const auto seen_by = [&](std::size_t view) {
            e->set_model(model);
            e->begin(setup_with(gs::accumulator::native));
            e->reserve();
            e->step(plan(view, 0.01f));
            return changed(model, e->get_model());
        };
        const std::vector<bool> first = seen_by(0), second = seen_by(1);
        e->set_model(model);
        e->step(plan(0, 0));  // gives momentum to visible Gaussians
        CHECK(same(e->get_model(), model));
        e->step(plan(1, 0.01f));
        const std::vector<bool> moved = changed(model, e->get_model());
        std::size_t hidden = 0, shown = 0;
        for (std::size_t i = 0; i < model.count(); ++i) {
            if (first[i] && !second[i]) ++hidden;
            if (second[i]) ++shown;
            CHECK(moved[i] == second[i]);
        }
        CHECK(hidden > 50);
        CHECK(shown > 50);
    }
}

TEST_CASE("an image too large to be numbered is refused") {
    const gs::scene scene = small_scene();
    gs::camera large = scene.test[0].camera;
    large.width = large.height = 23171;  // squared, beyond 2^29
    for (const auto make : engines()) {
        const auto e = make();
        gaussians model = gs::from_points(scene.points, 0, 1, 1);
        for (const std::size_t sky : {std::size_t{0}, gs::sky_width}) {
            model.sky.assign(sky, 0.0f);
            e->set_model(model);
            CHECK_THROWS_WITH_AS(e->render(large, {}),
                                 doctest::Contains("23171x23171 has more than 2^29 pixels"), gs::error);
        }
    }
}

TEST_CASE("what a photo has no depth map for, or one that does not agree, is learnt as if there were none") {
    gs::scene scene = small_scene("synthetic:spheres,depths=0");
    scene.train[1].depths = {};
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test, 1);
        const auto after = [&](std::size_t view, bool learns, float scale, int downscales) {
            e->set_model(gs::from_points(scene.points, 0, 3000, 1));
            gs::train::training_setup setup = setup_with(gs::accumulator::fixed);
            if (learns) setup.features["depth"] = depth_fits(scene, scale);
            e->begin(setup);
            e->reserve(downscales);
            e->step(plan_for(view));
            return e->get_model();
        };
        for (const int downscales : {0, 1}) {
            CAPTURE(downscales);
            CHECK(same(after(1, true, 1e-5f, downscales), after(1, false, 1e-5f, downscales)));
            CHECK(same(after(0, true, 0, downscales), after(0, false, 1e-5f, downscales)));
            CHECK_FALSE(same(after(0, true, 1e-5f, downscales), after(0, false, 1e-5f, downscales)));
        }
    }
}

TEST_CASE("a step whose lists do not fit changes nothing, and is counted") {
    const gs::scene scene = small_scene("synthetic:spheres,depths=0");
    const gaussians small = gs::from_points(scene.points, 0, 1, 1);
    gaussians large = gs::from_points(scene.points, 0, 3000, 1);
    for (float& s : large.log_scale)
        s = 0;  // each meets every tile: 27,000 instances, where 4,096 are reserved
    for (const auto make : engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        e->set_model(small);
        e->reserve();
        e->set_model(large);
        gs::train::training_setup setup;
        setup.features["depth"] = depth_fits(scene, 1e-5f);
        e->begin(setup);
        const gs::train::step_plan plan = plan_for(0);
        e->step(plan);
        CHECK(e->take_report().skipped == 1);
        CHECK(same(e->get_model(), large));
        e->reserve();
        e->step(plan);
        CHECK(e->take_report().skipped == 0);
        CHECK_FALSE(same(e->get_model(), large));
    }
}

TEST_CASE("what the CPU computes does not depend on its instruction set") {
    const gs::scene scene = small_scene();
    const gaussians model = gs::from_points(scene.points, 3, 3000, 1);
    std::vector<std::vector<float>> renders;
    std::vector<gaussians> stepped;
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);  // several add up gradients in any order
    for (const auto make : gs::train::cpu_engines()) {
        const auto e = make();
        e->set_views(scene.train, scene.test);
        e->set_model(model);
        e->reserve();
        renders.push_back(e->render(scene.test[0].camera, {1, 1, 1}));
        for (std::size_t v = 0; v < 3; ++v) e->step(plan_for(v));
        stepped.push_back(e->get_model());
        INFO(e->profile().device_name());
        CHECK(renders.back() == renders.front());
        CHECK(same(stepped.back(), stepped.front()));
    }
    omp_set_num_threads(threads);
    CHECK_FALSE(same(stepped.front(), model));
}

#if defined(WARPAGG_TEST_CUDA)
TEST_CASE("CPU and GPU draw the same image") {
    const gs::scene scene = small_scene();
    const gaussians model = gs::from_points(scene.points, 3, 3000, 1);
    const auto cpu = gs::train::make_cpu_engine(), gpu = gs::train::make_cuda_engine();
    cpu->set_model(model);
    gpu->set_model(model);
    for (const auto& v : scene.test)
        CHECK(psnr_between(cpu->render(v.camera, {1, 1, 1}), gpu->render(v.camera, {1, 1, 1})) > 60);
}
#endif
