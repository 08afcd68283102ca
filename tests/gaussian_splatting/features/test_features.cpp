// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "../training/engines.hpp"
#include "core/error.hpp"
#include "device/cpu/cpu.hpp"
#include "engine/sh_degree_state.hpp"
#include "evaluation/fit_exposure.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/depth/depth_agreement.hpp"
#include "features/exposure/exposures.hpp"
#include "features/exposure/held_out_exposures.hpp"
#include "features/resolve.hpp"
#include "features/sh_degree/revise_sh_degree.hpp"
#include "features/sh_degree/sh_degree_feature.hpp"
#include "features/sky/sky.hpp"
#include "losses/inverse_depth/depth_gradient.hpp"
#include "readers/load_scene.hpp"
#include "render/geometry/effect_set.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

gs::scene made(const char* parameters) {
    gs::load_options o;
    o.data = std::string("synthetic:") + parameters;
    o.resolution = 2;
    return gs::load_scene(o, {});
}

std::string refusal(const std::string& text) {
    try {
        parse_selection(text);
    } catch (const gs::error& e) {
        return e.what();
    }
    return "";
}

std::vector<float> random_render(std::mt19937& random, std::size_t values) {
    std::vector<float> render(values);
    for (float& x : render) x = static_cast<float>(random() % 1000) / 999;
    return render;
}

/// The names of the selectable features.
const selected_feature& outcome(const feature_set& features, std::size_t i) {
    REQUIRE(features.all().size() == 6);
    return features.all()[i];
}

/// The initial state of training.
int sh_degree_of(const feature_set& features) {
    const selected_feature& direction = outcome(features, 0);
    const int degree = first_sh_degree(direction.values);
    CHECK(direction.on == (degree > 0));
    return degree;
}

bool revises_sh_degree(const feature_set& features) {
    const std::vector<float>& values = outcome(features, 0).values;
    return values.size() > 1 && values[1] == 1;
}

/// The factor of each photo, which is the same for all channels; none without the feature.
std::vector<float> gains_of(const feature_set& features) {
    std::vector<float> gains;
    for (const exposure& e : exposures_from(features.values_if_on("exposure"))) {
        const float x = e[0];
        CHECK(e == exposure{x, 0, 0, 0, 0, x, 0, 0, 0, 0, x, 0});
        gains.push_back(x);
    }
    return gains;
}

std::vector<float> flattened_fits(const std::vector<gs::depth_fit>& fits) {
    std::vector<float> values;
    for (const gs::depth_fit& fit : fits) values.insert(values.end(), {fit.scale, fit.offset});
    return values;
}

}  // namespace

TEST_CASE("long: training simulates the recommended effects, or those that --effects names") {
    const gs::scene spheres = made("spheres"), glossy = made("spheres,gloss=0.6,exposure=0.3");
    const auto simulated = [](const gs::scene& scene, const char* selection, std::optional<int> degree = {}) {
        return resolve(scene, parse_selection(selection),
                       degree ? std::vector{explicit_sh_degree(*degree)} : std::vector<selected_feature>{});
    };
    const feature_set matte = simulated(spheres, "auto");
    CHECK(sh_degree_of(matte) == 0);
    CHECK(revises_sh_degree(matte));
    CHECK(gains_of(matte).empty());
    CHECK_FALSE(matte.is_on("antialiasing"));
    REQUIRE(matte.all().size() == 6);
    for (std::size_t i = 0;
         const char* name : {"direction", "exposure", "antialiasing", "sky", "masks", "depth"}) {
        CHECK(matte.all()[i].name == name);
        CHECK_FALSE(matte.all()[i++].on);
    }
    CHECK(outcome(matte, 1).reason.find("the brightness of the same points differs") != std::string::npos);

    const feature_set much = simulated(glossy, "auto,-exposure,+antialiasing");
    CHECK(sh_degree_of(much) > 0);
    CHECK(revises_sh_degree(much));
    CHECK(gains_of(much).empty());
    CHECK(outcome(much, 1).reason == "--effects auto,-exposure,+antialiasing");
    CHECK(much.is_on("antialiasing"));
    const feature_set exposed = simulated(glossy, "auto,-direction");
    CHECK(sh_degree_of(exposed) == 0);
    CHECK_FALSE(revises_sh_degree(exposed));
    CHECK(std::ranges::max(gains_of(exposed)) > 1.2f);
    CHECK(std::ranges::min(gains_of(exposed)) < 0.8f);

    CHECK(sh_degree_of(simulated(spheres, "all")) == 3);
    CHECK(gains_of(simulated(spheres, "all")) == std::vector<float>(48, 1.0f));
    CHECK_FALSE(revises_sh_degree(simulated(spheres, "all")));
    CHECK(sh_degree_of(simulated(glossy, "none")) == 0);
    CHECK(sh_degree_of(simulated(spheres, "+direction,-exposure,-antialiasing,-sky,-masks,-depth")) == 3);
    const feature_set listed = simulated(spheres, "exposure,direction");
    CHECK_FALSE(gains_of(listed).empty());
    CHECK(sh_degree_of(listed) == 3);
    CHECK_FALSE(listed.is_on("antialiasing"));
    CHECK(sh_degree_of(simulated(glossy, "auto", 1)) == 1);
    CHECK_FALSE(outcome(simulated(glossy, "auto", 0), 0).on);
    const feature_set settled =
        simulated(spheres, "auto,-exposure,-antialiasing,-sky,-masks,-depth", 2);  // nothing to look for
    CHECK(sh_degree_of(settled) == 2);
    CHECK_FALSE(revises_sh_degree(settled));
    CHECK(outcome(settled, 0).reason == "--sh-degree 2");

    const feature_set under_sky = simulated(made("spheres,sky=0.7"), "auto");
    CHECK(outcome(under_sky, 3).on);
    CHECK(under_sky.values_if_on("sky").size() == gs::sky_width);
    CHECK(std::abs(under_sky.values_if_on("sky")[0]) > 0.1f);
    CHECK(matte.values_if_on("sky").empty());
    CHECK(simulated(spheres, "all").values_if_on("sky") == std::vector<float>(gs::sky_width, 0.0f));
    CHECK(simulated(made("alpha"), "all").values_if_on("sky").empty());
    CHECK(outcome(simulated(made("alpha"), "all"), 3).reason == "photos have transparent parts");
    CHECK(outcome(simulated(spheres, "all"), 4).reason == "no training photo has masked pixels");
    const feature_set masked = simulated(made("spheres,passers=0.1"), "auto");
    CHECK(outcome(masked, 4).on);
    CHECK(outcome(masked, 4).reason.starts_with("48 of 48 photos have masks, which exclude "));

    CHECK(outcome(simulated(spheres, "all"), 5).reason == "no training photo has a depth map");
    CHECK(simulated(spheres, "all").values_if_on("depth").empty());
    const gs::scene estimated = made("spheres,views=4,points=1000,depths=0.02");
    CHECK(simulated(estimated, "none").values_if_on("depth").empty());
    for (const char* text : {"auto", "depth"}) {
        const feature_set deep = simulated(estimated, text);
        CHECK(outcome(deep, 5).on);
        const std::vector<float> fits = deep.values_if_on("depth");
        REQUIRE(fits.size() == 8);
        for (std::size_t i = 0; i < 8; i += 2) CHECK(fits[i] > 0);
    }
    const feature_set wrong = simulated(made("spheres,views=4,depths=10"), "all");
    CHECK_FALSE(outcome(wrong, 5).on);
    CHECK(outcome(wrong, 5).reason.starts_with(
        "4 of 4 photos have depth maps, of which 0 agree with the points; the median correlation is "));
}

TEST_CASE("a selection of effects that is none is refused") {
    for (const char* text : {"auto", "all", "none", "direction", "exposure,antialiasing", "+direction",
                             "auto,-exposure", "none,+exposure", "all,-direction"}) {
        CAPTURE(text);
        CHECK(refusal(text) == "");
    }
    CHECK(refusal("glare") ==
          "--effects: there is no effect 'glare'; the effects are direction, exposure, antialiasing, sky, "
          "masks, "
          "depth");
    CHECK(parse_selection("auto").allows("masks"));
    CHECK(parse_selection("masks").allows("masks"));
    CHECK_FALSE(parse_selection("none").allows("masks"));
    CHECK_FALSE(parse_selection("all,-masks").allows("masks"));
    CHECK(parse_selection("all,-masks").allows("depth"));
    for (const char* text : {"auto,exposure", "exposure,+direction", "exposure,auto", ""}) {
        CAPTURE(text);
        CHECK(refusal(text).starts_with("--effects"));
    }
}

TEST_CASE("gradients by the image and by the exposure are those of central differences") {
    using device_type = gs::device::cpu;
    device_type device;
    std::mt19937 random(1);
    for (const std::size_t pixels : {1, 31, 700}) {
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
        for (int i = 0; i < 30; ++i) exposures.learn(1, render.data(), weights.data(), pixels, 0.02f, {});
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
        const float* by = exposures.learn(1, render.data(), weights.data(), pixels, 0, {});
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
    exposures.learn(0, render.data(), render.data(), 1, 0.1f, {&required, 1});
    CHECK(exposures.get() == before);
    exposures.learn(0, render.data(), nothing.data(), 1, 0.1f, {});
    CHECK(exposures.get() == before);
    exposures.learn(0, render.data(), render.data(), 1, 0.1f, {&required, 2});
    CHECK(exposures.get() != before);
}

TEST_CASE("a sky is drawn by direction, and its gradients are those of central differences") {
    gs::device::cpu device;
    using warp = gs::device::cpu::warp;
    std::mt19937 random(3);
    for (const auto& [width, height, world] : {std::tuple{1, 1, "spheres"},
                                               {37, 19, "spheres"},
                                               {64, 8, "spheres"},
                                               {37, 19, "spheres,fisheye=150"}}) {
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
        const auto sums = numbers.sums(sky_patch<warp, false>::count(width, height));
        gs::raster::with_flag(camera.fisheye.has_value(), [&]<bool Fisheye> {
            device.for_each_warp(
                sums.warps,
                sky_backward<warp, Fisheye>{gs::raster::for_device<warpagg::value_t<warp, float>>(camera),
                                            through.data(), weights.data(), sums});
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

TEST_CASE("an inverse depth is drawn to what its map says, and to nothing that it does not know") {
    const std::vector<float> drawn{0.2f, 0.4f, 0.3f, 0.3f, 0.1f};
    const std::vector<std::uint16_t> map{100, 100, 100, 0, 1};  // 0.3, and below zero
    std::vector<float> gradient(15, 7.0f);
    const gs::train::depth_gradient kernel{drawn.data(), map.data(), {0.004f, -0.1f},
                                           0.5f,         5,          gradient.data()};
    for (std::size_t i = 0; i < 5; ++i) kernel(i);
    CHECK(gradient[0] == -0.5f);
    CHECK(gradient[1] == 0.5f);
    CHECK(std::abs(gradient[2]) <= 0.5f);
    CHECK(gradient[3] == 0);
    CHECK(gradient[4] == 0.5f);
    for (std::size_t i = 5; i < 15; ++i) CHECK(gradient[i] == 0);
}

TEST_CASE("quality: with depth maps, few photos with few points make a better scene") {
    for (const auto make : engines()) {
        double gain = 0;
        for (const std::uint64_t seed : {0, 1, 2, 3}) {
            gs::load_options from;
            from.data = "synthetic:spheres,views=4,points=300,depths=0.02";
            from.resolution = 48;
            from.eval = true;
            from.seed = seed;
            const gs::scene scene = gs::load_scene(from, {});
            const auto psnr_with = [&](const std::vector<gs::depth_fit>& fits) {
                const auto e = make();
                gs::train::train_options o;
                o.schedule.iterations = 1500;
                o.schedule.sh_degree = 0;
                o.max_cap = 4000;
                o.seed = seed;
                o.gradient = gs::accumulator::fixed;  // the same whenever it is run: runs differ by a dB
                // Regularization corrects much of what depth maps correct.
                o.schedule.dropout = 0;
                o.densification.of<gs::train::adaptive_config>().opacity_penalty = 0;
                if (!fits.empty()) o.features = feature_set({{"depth", true, "", flattened_fits(fits)}});
                e->set_views(scene.train, scene.test, o.schedule.num_downscales);
                e->set_model(gs::from_points(scene.points, 0, 4000, seed));
                gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
                return gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr();
            };
            const depth_agreement found = compare_depths(scene);
            CHECK(found.agreeing >= 3);
            gain += psnr_with(found.fits) / 4 - psnr_with({}) / 4;
        }
        MESSAGE("depth maps bring " << gain << " dB");
        CHECK(gain > 0.1);
    }
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

TEST_CASE("long: masks: an object that passes in front of the cameras leaves no trace") {
    const gs::scene truth = small_scene("synthetic:spheres", 48);
    for (const auto make : engines()) {
        const auto psnr_of = [&](const char* data, bool masks) {
            gs::load_options from;
            from.data = data;
            from.resolution = 48;
            from.eval = true;
            from.masks = masks;
            gs::scene scene = gs::load_scene(from, {});
            scene.test = truth.test;
            for (std::size_t v = 0; v < scene.train.size(); v += 4)  // and some without
                scene.train[v] = truth.train[v];
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 600;
            o.schedule.sh_degree = 0;
            o.max_cap = 4000;
            e->set_views(scene.train, scene.test, o.schedule.num_downscales);
            e->set_model(gs::from_points(scene.points, 0, 3000, 1));
            gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
            return gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr();
        };
        const double clean = psnr_of("synthetic:spheres", true);
        const double masked = psnr_of("synthetic:spheres,passers=0.25", true);
        const double spoilt = psnr_of("synthetic:spheres,passers=0.25", false);
        CHECK(masked > clean - 2);  // which has a quarter more to learn from
        CHECK(masked > spoilt + 1);
    }
}

TEST_CASE("bands go, with their memory, where training is told so, and come as zeros") {
    const gs::scene scene = small_scene();
    for (const auto make : engines())
        for (const int degree : {0, 1, 2, 3}) {
            CAPTURE(degree);
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 40;
            o.schedule.sh_degree = 2;
            o.schedule.sh_degree_interval = 5;
            o.schedule.sh_lr = 1e-9;
            o.max_cap = 4000;
            e->set_views(scene.train, {}, o.schedule.num_downscales);
            gs::gaussians model = gs::from_points(scene.points, 2, 3000, 1);
            std::ranges::fill(model.sh_rest, 0.01f);
            e->set_model(model);
            const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
            gs::train::training training(*e, scene, o, quiet);
            int reviews = 0;
            schedule_revision(training,
                              [&](int sh_degree) {
                                  ++reviews;
                                  CHECK(sh_degree == 2);
                                  return degree;
                              },
                              {});
            training.run();
            CHECK(training.schedule().sh_degree == degree);
            CHECK(reviews == 1);
            const gs::gaussians after = e->get_model();
            CHECK(after.sh_degree == degree);
            const auto rest = static_cast<std::size_t>(after.rest_width());
            REQUIRE(after.sh_rest.size() == rest * e->count());
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < after.sh_rest.size(); ++i)
                wrong += std::abs(after.sh_rest[i] - (i % rest < 24 ? 0.01f : 0.0f)) > 1e-5f;
            CHECK(wrong == 0);
        }
}

TEST_CASE("long: sh_degree: the revision adds degrees that images need, and drops invisible ones") {
    for (const auto make : engines())
        for (const char* name : {"synthetic:spheres,gloss=0.8", "synthetic:spheres,noise=0.1"}) {
            CAPTURE(name);
            const bool glossy = std::string(name).find("gloss") != std::string::npos;
            const gs::scene scene = small_scene(name, 64);
            const auto e = make();
            gs::train::train_options o;
            o.schedule.iterations = 300;
            o.schedule.sh_degree = 0;
            o.max_cap = 2000;
            e->set_views(scene.train, {}, o.schedule.num_downscales);
            e->set_model(gs::from_points(scene.points, 0, 2000, 1));
            const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
            gs::train::train(*e, scene, o, quiet);
            const show_function as_rendered = o.features.show_on_host(*e, scene);
            const sh_review left = revise_sh_degree(*e, scene, as_rendered, {}, 0);
            CHECK((glossy ? left.sh_degree >= 2 : left.sh_degree == 0));
            CHECK_FALSE(left.change);
            CHECK(left.unexplained[0] > 0);
            if (glossy) continue;
            dynamic_cast<gs::train::sh_degree_state&>(e->feature("direction")).set_degree(2);
            CHECK(revise_sh_degree(*e, scene, as_rendered, {}, 2).sh_degree == 0);
            gs::gaussians model = e->get_model();
            for (std::size_t i = 0; i < model.sh_rest.size(); ++i)
                if (i % 24 < 9) model.sh_rest[i] = 0.02f;  // the band of degree 1
            e->set_model(model);
            const sh_review kept = revise_sh_degree(*e, scene, as_rendered, {}, 2);
            CHECK(kept.sh_degree == 1);
            REQUIRE(kept.change);
            CHECK(*kept.change > band_change_limit);
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
