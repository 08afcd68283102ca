// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/resolve.hpp"
#include "features/vignetting/lens_groups.hpp"
#include "features/vignetting/vignetting_feature.hpp"
#include "random_render.hpp"
#include "readers/synthetic/synthetic_parameters.hpp"
#include "readers/synthetic/synthetic_vignetting.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;
using gs_test::random_render;

const std::vector<float> some_parameters{0.3f, 0.4f, 0.6f, 0.5f, 0.1f, 0.2f, 0.7f, 0.05f, 0.3f};

/// A camera whose principal point is not the middle of the image.
gs::camera some_camera(int width, int height) {
    gs::camera c{width, height, 40, 42, 0.46 * width, 0.55 * height};
    return c;
}

/// The falloff of a channel, in double precision and by the formula of powers of u.
double falloff_in_doubles(double u, const std::vector<double>& p, std::size_t channel) {
    const double rest = 1 - u;
    const std::array basis{1 - rest * rest * rest, 3 * u * u - 2 * u * u * u, u * u * u};
    double sum = 1;
    for (std::size_t k = 0; k < 3; ++k) sum += p[3 * channel + k] * basis[k];
    return 1 / sum;
}

/// The sum of weights times darkened values, in double precision.
double weighted_sum(const gs::camera& c, const std::vector<double>& image, const std::vector<double>& p,
                    const std::vector<float>& weights) {
    const double x = std::max(c.cx, c.width - c.cx), y = std::max(c.cy, c.height - c.cy);
    double sum = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const std::size_t pixels = image.size() / 3, pixel = i % pixels;
        const double dx = static_cast<double>(pixel % static_cast<std::size_t>(c.width)) + 0.5 - c.cx,
                     dy = static_cast<double>(pixel / static_cast<std::size_t>(c.width)) + 0.5 - c.cy;
        const double u = (dx * dx + dy * dy) / (x * x + y * y);
        sum += static_cast<double>(weights[i]) * image[i] * falloff_in_doubles(u, p, i / pixels);
    }
    return sum;
}

struct training_run {
    double psnr;
    std::vector<float> values;
    gs::gaussians model;
};

training_run trained(make_engine make, const gs::scene& scene, const std::vector<selected_feature>& selected,
                     int iterations, gs::accumulator sums = gs::accumulator::native, std::uint64_t seed = 0) {
    const auto e = make();
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    o.max_cap = 10000;
    o.seed = seed;
    o.gradient = sums;
    o.features = feature_set(selected);
    e->set_views(scene.train, scene.test, o.schedule.num_downscales);
    gs::gaussians model = gs::from_points(scene.points, 0, 3000, 1);
    model.antialiased = true;  // otherwise, the brightness of details depends on their distance
    e->set_model(model);
    const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    gs::train::train(*e, scene, o, quiet);
    if (!selected.empty()) o.features.before_evaluation(*e, scene);
    return {gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr(), e->feature("vignetting").values(),
            e->get_model()};
}

std::vector<selected_feature> vignetting_of(const gs::scene& scene) {
    return {{"vignetting", true, "", vignetting_feature().neutral_values(scene)}};
}

/// The largest difference of the learned falloff of the first lens and that of the synthetic scene, up to
/// this distance from the center, relative to the corner.
double largest_error(const gs::scene& scene, const std::vector<float>& values, double strength, double end) {
    const falloff_values learned(values, scene.train.size());
    const std::vector<double> parameters(learned.of(0), learned.of(0) + falloff_width);
    gs::synthetic_parameters how;
    how.vignetting = strength;
    const gs::camera& c = scene.train[0].camera;
    double largest = 0;
    for (double radius = 0; radius <= end; radius += 0.02) {
        const auto truth =
            gs::synthetic_falloff(how, c, c.cx + radius * 0.5 * c.width, c.cy + radius * 0.5 * c.height);
        for (std::size_t channel = 0; channel < 3; ++channel)
            largest = std::max(
                largest, std::abs(falloff_in_doubles(radius * radius, parameters, channel) - truth[channel]));
    }
    return largest;
}

finding found_in(const std::string& parameters) {
    gs::load_options o;
    o.data = "synthetic:" + parameters;
    const gs::scene scene = gs::load_scene(o, {});
    return vignetting_feature().analyze(gs::scene_statistics(scene));
}

}  // namespace

TEST_CASE("vignetting: gradients agree with central differences in double precision") {
    using device_type = gs::device::cpu;
    using patch = pixel_patch<device_type::warp>;
    device_type device;
    std::mt19937 random(1);
    for (const auto& [width, height] : {std::pair{1, 1}, {31, 1}, {35, 20}}) {
        CAPTURE(width);
        const gs::camera camera = some_camera(width, height);
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        const auto image = random_render(random, 3 * pixels), weights = random_render(random, 3 * pixels);
        const std::vector<double> precise(image.begin(), image.end());
        const std::vector<double> parameters(some_parameters.begin(), some_parameters.end());
        const falloff_geometry geometry = geometry_of(camera);
        const std::size_t patches = patch::count(width, height);

        std::vector<float> darkened(3 * pixels), by_image(3 * pixels), parts(falloff_width * patches);
        device.for_each_warp(patches,
                             darken_corners{image.data(), some_parameters.data(), geometry, darkened.data()});
        double sum = 0;
        for (std::size_t i = 0; i < darkened.size(); ++i)
            sum += static_cast<double>(weights[i]) * static_cast<double>(darkened[i]);
        CHECK(sum == doctest::Approx(weighted_sum(camera, precise, parameters, weights)).epsilon(1e-5));

        device.for_each_warp(patches, darken_corners_backward{image.data(),
                                                              some_parameters.data(),
                                                              weights.data(),
                                                              geometry,
                                                              by_image.data(),
                                                              {parts.data(), patches},
                                                              0});
        constexpr double step = 1e-4;
        for (unsigned k = 0; k < falloff_width; ++k) {
            CAPTURE(k);
            double by_parameter = 0;
            for (std::size_t p = 0; p < patches; ++p)
                by_parameter += static_cast<double>(parts[k * patches + p]);
            auto more = parameters, less = parameters;
            more[k] += step;
            less[k] -= step;
            const double difference = (weighted_sum(camera, precise, more, weights) -
                                       weighted_sum(camera, precise, less, weights)) /
                                      (2 * step);
            CHECK(by_parameter == doctest::Approx(difference).epsilon(2e-5));
        }
        for (const std::size_t i : {std::size_t{0}, pixels - 1, 2 * pixels}) {
            auto more = precise, less = precise;
            more[i] += step;
            less[i] -= step;
            const double difference = (weighted_sum(camera, more, parameters, weights) -
                                       weighted_sum(camera, less, parameters, weights)) /
                                      (2 * step);
            CHECK(static_cast<double>(by_image[i]) == doctest::Approx(difference).epsilon(2e-5));
        }
    }
}

TEST_CASE("vignetting: a falloff is one at the center and never rises outward, whatever its parameters are") {
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 30; ++i) {
        const float parameters[falloff_terms]{std::abs(normal(random)), 0, std::abs(3 * normal(random))};
        float before = 1;
        for (int step = 0; step <= 100; ++step) {
            float basis[falloff_terms];
            falloff_basis(static_cast<float>(step) / 100, basis);
            const float factor = falloff(basis, parameters);
            if (step == 0) CHECK(factor == 1);
            CHECK(factor > 0);
            CHECK(factor <= before + 1e-6f);
            before = factor;
        }
    }
}

TEST_CASE("vignetting: a step without room, or whose gradient is not finite, leaves the falloff") {
    gs::device::cpu device;
    falloffs<gs::device::cpu> lenses(device);
    lenses.set(some_parameters);
    const falloff_geometry geometry = geometry_of(some_camera(4, 3));
    const std::vector<float> image(36, 0.5f), nothing(36, std::numeric_limits<float>::quiet_NaN());
    const std::uint64_t required = 2;
    lenses.learn(0, image.data(), image.data(), geometry, {}, 0.1f, {&required, 1});
    CHECK(lenses.get() == some_parameters);
    lenses.learn(0, image.data(), nothing.data(), geometry, {}, 0.1f, {});
    CHECK(lenses.get() == some_parameters);
    lenses.learn(0, image.data(), image.data(), geometry, {}, 0.1f, {&required, 2});
    for (std::size_t k = 0; k < falloff_width; ++k) CHECK(lenses.get()[k] > some_parameters[k]);
    // A brighter corner than the center is no falloff.
    const std::vector<float> darker(36, -0.5f);
    for (int i = 0; i < 50; ++i) lenses.learn(0, image.data(), darker.data(), geometry, {}, 0.1f, {});
    CHECK(lenses.get() == std::vector<float>(falloff_width, 0.0f));
}

TEST_CASE("vignetting: photos of one lens share a falloff, upright or not, and panoramas have none") {
    gs::scene scene;
    const auto add = [&](int width, int height, double focal) {
        scene.train.emplace_back().camera = {width, height, focal, focal, 0.5 * width, 0.5 * height};
    };
    add(600, 400, 500);
    add(400, 600, 505);
    add(598, 402, 490);
    add(600, 400, 700);   // zoomed
    add(1200, 800, 500);  // another size
    scene.train.emplace_back().camera = gs::camera::panorama(600, 300);
    add(600, 400, 500);
    scene.train.back().camera.fisheye = gs::fisheye({0.02, 0, 0, 0});
    const falloff_values values(vignetting_feature().neutral_values(scene), scene.train.size());
    CHECK(values.lens_of_view == std::vector{0, 0, 0, 1, 2, -1, 3});
    CHECK(values.parameters.size() == 4 * falloff_width);
    CHECK(vignetting_feature().obstacle(scene, {}).empty());
    scene.has_alpha = true;
    CHECK(vignetting_feature().obstacle(scene, {}) ==
          "photos have transparent parts, whose background has no falloff");
    scene.has_alpha = false;
    scene.train = {scene.train[5]};
    CHECK(vignetting_feature().obstacle(scene, {}) ==
          "all photos are panoramas, which are put together from several photos");
}

TEST_CASE("vignetting: held-out and training views are shown with the falloff of their lens") {
    const gs::scene scene = small_scene("synthetic:spheres,vignetting=0.3", 48);
    const vignetting_feature feature;
    for (const auto make : engines()) {
        const auto e = make();
        gs::train::train_options o;
        o.schedule.iterations = 1;
        falloff_values values(feature.neutral_values(scene), scene.train.size());
        values.parameters = some_parameters;
        o.features = feature_set({{"vignetting", true, "", values.flattened()}});
        e->set_views(scene.train, scene.test);
        e->set_model(gs::from_points(scene.points, 0, 1000, 1));
        const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
        const gs::train::training training(*e, scene, o, quiet);
        CHECK(e->feature("vignetting").values() == values.flattened());
        std::vector<float> plain, darker;
        e->measure(1, {}, &plain);
        feature.before_evaluation(*e, scene);
        e->measure(1, {}, &darker);
        // The camera of a training view is not that of a held-out one, but its lens is.
        feature.show_on_host(*e, scene)(0, {48, 48}, plain);
        double largest = 0;
        for (std::size_t i = 0; i < plain.size(); ++i)
            largest = std::max(largest, static_cast<double>(std::abs(plain[i] - darker[i])));
        CHECK(largest < 1e-6);
        std::vector<float> small(3 * 24 * 24, 1.0f), large(3 * 48 * 48, 1.0f);
        feature.show_on_host(*e, scene)(0, {24, 24}, small);
        feature.show_on_host(*e, scene)(0, {48, 48}, large);
        CHECK(small[0] == doctest::Approx(large[0]).epsilon(0.02));  // a corner
        CHECK(small[12 * 24 + 12] > 0.99f);
        const std::vector<std::uint32_t> places{0, 47, 1000};
        std::vector<float> some(3 * places.size(), 1.0f);
        feature.show_on_host(*e, scene)(0, {48, 48, places}, some);
        for (std::size_t i = 0; i < some.size(); ++i)
            CHECK(some[i] == large[i / 3 * 48 * 48 + places[i % 3]]);
        e->feature("vignetting").set_held_out_values({});
        e->measure(1, {}, &plain);
        CHECK(plain[0] >= darker[0]);
    }
}

TEST_CASE("vignetting: a training learns the falloff, with equal bits each time, and writes it") {
    const gs::scene scene =
        small_scene("synthetic:spheres,distance=0.5,scales=2,vignetting=0.5,views=16", 24);
    for (const auto make : engines()) {
        const auto on = trained(make, scene, vignetting_of(scene), 120, gs::accumulator::fixed),
                   again = trained(make, scene, vignetting_of(scene), 120, gs::accumulator::fixed);
        CHECK(on.values == again.values);
        CHECK(on.model.mean == again.model.mean);
        CHECK(trained(make, scene, {}, 2).values.empty());
        const falloff_values learned(on.values, scene.train.size());
        REQUIRE(learned.parameters.size() == falloff_width);
        float basis[falloff_terms];
        falloff_basis(0.8f, basis);
        for (unsigned c = 0; c < 3; ++c) CHECK(falloff(basis, learned.of(0) + falloff_at(c, 0)) < 0.96f);
    }
}

TEST_CASE("vignetting: the file has the factors of each lens") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    const gs_test::temporary_folder folder;
    const auto e = gs::train::make_cpu_engine();
    gs::train::train_options o;
    falloff_values values(vignetting_feature().neutral_values(scene), scene.train.size());
    values.parameters = some_parameters;
    o.features = feature_set({{"vignetting", true, "", values.flattened()}});
    e->set_views(scene.train, scene.test);
    e->set_model(gs::from_points(scene.points, 0, 100, 1));
    const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    const gs::train::training training(*e, scene, o, quiet);
    o.features.write_results(*e, scene, folder.path());
    const auto lens = nlohmann::json::parse(std::ifstream(folder / "vignetting.json")).at("lenses").at(0);
    CHECK(lens.at("photos") == scene.train.size());
    CHECK(lens.at("width") == 24);
    const auto& blue = lens.at("falloff").at("blue");
    REQUIRE(blue.size() == 11);
    CHECK(blue.at(0) == 1);
    const std::vector<double> parameters(some_parameters.begin(), some_parameters.end());
    CHECK(blue.at(5).get<double>() == doctest::Approx(falloff_in_doubles(0.25, parameters, 2)));
    CHECK(blue.at(10).get<double>() == doctest::Approx(1 / (1 + 0.7 + 0.05 + 0.3)));
    feature_set({{"vignetting", false, "", {}}}).write_results(*e, scene, folder.path());
    CHECK_FALSE(std::filesystem::exists(folder / "vignetting.json"));
}

TEST_CASE("vignetting: detection finds the falloff, also with exposures, gloss and noise") {
    const finding clear = found_in("spheres,vignetting=0.3,exposure=0.3,gloss=0.5,noise=0.02");
    CHECK(clear.recommended == true);
    REQUIRE(clear.values.size() == 48 + falloff_width);
    float at_corner[falloff_terms]{1, 1, 1};
    CHECK(falloff(at_corner, clear.values.data() + 48) < 0.95f);
    CHECK(found_in("spheres,vignetting=0.3,points=40,views=8").recommended == std::nullopt);
}

TEST_CASE("long: vignetting: detection decides right on scenes with many causes of different brightness") {
    for (const char* scene :
         {"spheres,vignetting=0.2", "spheres,vignetting=0.4,gloss=1,exposure=0.4,noise=0.03",
          "spheres,vignetting=0.3,sky=0.8,gloss=0.5", "spheres,vignetting=0.3,moving=0.5,noise=0.03",
          "spheres,vignetting=0.4,walls=0.8,noise=0.03", "spheres,vignetting=0.4,fisheye=60"}) {
        CAPTURE(std::string(scene));
        CHECK(found_in(scene).recommended == true);
    }
    for (const char* scene :
         {"spheres", "spheres,gloss=1", "spheres,scales=4", "spheres,sky=0.8,gloss=0.5", "spheres,poses=1",
          "spheres,moving=0.5,exposure=0.5", "spheres,walls=0.8", "spheres,noise=0.05",
          "spheres,fisheye=60,gloss=0.7", "spheres,panorama=1", "alpha,gloss=1"}) {
        CAPTURE(std::string(scene));
        CHECK(found_in(scene).recommended != true);
    }
}

TEST_CASE("long: vignetting: a training recovers the falloff and the scene") {
    constexpr double strength = 0.4;
    // Cameras at different distances show each point at different distances from the center.
    const gs::scene clean = small_scene("synthetic:spheres,distance=0.5,scales=2", 48),
                    dark = small_scene("synthetic:spheres,distance=0.5,scales=2,vignetting=0.4", 48);
    for (const auto make : engines()) {
        std::array<double, 4> mean{};
        for (const std::uint64_t seed : {0, 1}) {
            const auto run = [&](const gs::scene& scene, bool learns) {
                return trained(make, scene, learns ? vignetting_of(scene) : std::vector<selected_feature>{},
                               1500, gs::accumulator::native, seed);
            };
            const training_run learned = run(dark, true);
            CHECK(largest_error(dark, learned.values, strength, 0.9) < 0.03);
            mean[0] += run(clean, false).psnr / 2;
            mean[1] += run(clean, true).psnr / 2;
            mean[2] += run(dark, false).psnr / 2;
            mean[3] += learned.psnr / 2;
        }
        CAPTURE(mean);
        CHECK(mean[1] > mean[0] - 0.1);
        CHECK(mean[3] > mean[0] - 0.1);
        CHECK(mean[3] > mean[2] + 1);
    }
}
