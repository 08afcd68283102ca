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
#include "features/exposure/exposure_feature.hpp"
#include "features/resolve.hpp"
#include "features/response/response_feature.hpp"
#include "random_render.hpp"
#include "readers/synthetic/synthetic_response.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;
using gs::device::cpu;
using gs_test::random_render;

const std::vector<float> some_increments{0.1f,  0.3f, 0.2f, 0.3f,  0.1f,  0.02f, 0.5f, 0.1f,
                                         0.08f, 0.3f, 0.4f, 0.25f, 0.15f, 0.1f,  0.1f};
const std::vector<float> equal_increments(response_width, 1.0f / response_degree);

/// The curve of a channel, in double precision and by the formula of binomials.
double curve_in_doubles(double x, const std::vector<double>& increments, std::size_t channel) {
    x = std::clamp(x, 0.0, 1.0);
    const std::array binomials{1, 5, 10, 10, 5, 1};
    double coefficient = 0, sum = 0;
    for (int k = 1; k <= 5; ++k) {
        coefficient += increments[5 * channel + static_cast<std::size_t>(k) - 1];
        sum += coefficient * binomials[static_cast<std::size_t>(k)] * std::pow(x, k) * std::pow(1 - x, 5 - k);
    }
    return sum / coefficient;
}

/// The sum of weights times shown values, in double precision.
double weighted_sum(const std::vector<double>& render, const std::vector<double>& increments,
                    const std::vector<float>& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < render.size(); ++i)
        sum += static_cast<double>(weights[i]) *
               curve_in_doubles(render[i], increments, i / (render.size() / 3));
    return sum;
}

struct backward_result {
    std::vector<float> by_render;
    std::vector<double> by_increment;
};

backward_result response_gradients(int width, int height, const std::vector<float>& render,
                                   const std::vector<float>& increments, const std::vector<float>& by_shown) {
    cpu device;
    const std::size_t patches = pixel_patch<cpu::warp>::count(width, height);
    std::vector<float> parts(response_width * patches);
    backward_result found{std::vector<float>(render.size()), std::vector<double>(response_width)};
    device.for_each_warp(patches, respond_backward{render.data(),
                                                   increments.data(),
                                                   by_shown.data(),
                                                   width,
                                                   height,
                                                   found.by_render.data(),
                                                   {parts.data(), patches},
                                                   0});
    for (std::size_t i = 0; i < parts.size(); ++i)
        found.by_increment[i / patches] += static_cast<double>(parts[i]);
    return found;
}

std::vector<float> shown_with(const std::vector<float>& render, const std::vector<float>& increments) {
    cpu device;
    std::vector<float> result(render.size());
    device.for_each_index(render.size() / 3,
                          apply_response{render.data(), increments.data(), render.size() / 3, result.data()});
    return result;
}

const gs::train::train_events no_events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};

gs::train::train_options options_with(const std::vector<selected_feature>& selected, int iterations) {
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    o.max_cap = 10000;
    o.features = feature_set(selected);
    return o;
}

selected_feature response_on(const gs::scene& scene) {
    return {"response", true, "", response_feature().neutral_values(scene)};
}
selected_feature exposure_in(const gs::scene& scene) {
    return {"exposure", true, "", exposure_feature().analyze(gs::scene_statistics(scene)).values};
}

/// The PSNR of held-out views, each with the exposure that fits best before the response.
double exposed_psnr(gs::train::engine& e, const gs::scene& scene, const std::vector<float>& increments) {
    double sum = 0;
    for (std::size_t v = 0; v < scene.test.size(); ++v) {
        std::vector<float> render;
        e.measure(v, {}, &render);
        const std::size_t pixels = render.size() / 3;
        double least = std::numeric_limits<double>::infinity();
        for (int step = -100; step <= 100; ++step) {
            const double factor = std::exp2(0.02 * step);
            double squares = 0;
            for (std::size_t i = 0; i < render.size(); ++i) {
                const float* own = increments.data() + response_at(static_cast<unsigned>(i / pixels), 0);
                const double difference = respond(factor * static_cast<double>(render[i]), own) -
                                          scene.test[v].pixels.rgba[4 * (i % pixels) + i / pixels] / 255.0;
                squares += difference * difference;
            }
            least = std::min(least, squares / static_cast<double>(render.size()));
        }
        sum -= 10 * std::log10(least);
    }
    return sum / static_cast<double>(scene.test.size());
}

struct response_run {
    double psnr;
    std::vector<float> increments;  ///< of the first lens, or those of the identity
    gs::gaussians model;
};

response_run trained_with(make_engine make, const gs::scene& scene,
                          const std::vector<selected_feature>& selected, int iterations,
                          gs::accumulator sums = gs::accumulator::native, std::uint64_t seed = 0) {
    const auto e = make();
    gs::train::train_options o = options_with(selected, iterations);
    o.seed = seed;
    o.gradient = sums;
    e->set_views(scene.train, scene.test, o.schedule.num_downscales);
    gs::gaussians model = gs::from_points(scene.points, 0, 3000, 1);
    model.antialiased = true;
    e->set_model(model);
    gs::train::train(*e, scene, o, no_events);
    response_run made{0, equal_increments, e->get_model()};
    const auto values = e->feature("response").values();
    if (!values.empty()) made.increments = response_values(values, scene.train.size()).parameters;
    made.psnr = exposed_psnr(*e, scene, made.increments);
    return made;
}

finding response_in(const std::string& parameters) {
    gs::load_options o;
    o.data = "synthetic:" + parameters;
    const gs::scene scene = gs::load_scene(o, {});
    return response_feature().analyze(gs::scene_statistics(scene));
}

}  // namespace

TEST_CASE("response: gradients agree with central differences in double precision") {
    std::mt19937 random(1);
    for (const auto& [width, height] : {std::pair{1, 1}, {31, 1}, {35, 20}}) {
        CAPTURE(width);
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        auto render = random_render(random, 3 * pixels);
        for (float& x : render) x = std::clamp(x, 0.01f, 0.99f);
        const auto weights = random_render(random, 3 * pixels);
        const std::vector<double> precise(render.begin(), render.end());
        const std::vector<double> increments(some_increments.begin(), some_increments.end());
        const std::vector<float> result = shown_with(render, some_increments);
        double sum = 0;
        for (std::size_t i = 0; i < result.size(); ++i)
            sum += static_cast<double>(weights[i]) * static_cast<double>(result[i]);
        CHECK(sum == doctest::Approx(weighted_sum(precise, increments, weights)).epsilon(1e-5));

        const backward_result found = response_gradients(width, height, render, some_increments, weights);
        constexpr double step = 1e-4;
        double size = 0;
        for (const float w : weights) size += static_cast<double>(std::abs(w));
        for (unsigned k = 0; k < response_width; ++k) {
            CAPTURE(k);
            auto more = increments, less = increments;
            more[k] += step;
            less[k] -= step;
            const double difference =
                (weighted_sum(precise, more, weights) - weighted_sum(precise, less, weights)) / (2 * step);
            CHECK(std::abs(found.by_increment[k] - difference) < 3e-6 * size);
        }
        for (const std::size_t i : {std::size_t{0}, pixels - 1, 2 * pixels}) {
            auto more = precise, less = precise;
            more[i] += step;
            less[i] -= step;
            const double difference =
                (weighted_sum(more, increments, weights) - weighted_sum(less, increments, weights)) /
                (2 * step);
            CHECK(static_cast<double>(found.by_render[i]) == doctest::Approx(difference).epsilon(2e-5));
        }
    }
}

TEST_CASE("response: a curve rises from 0 to 1, and equal increments give the identity") {
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    cpu device;
    for (int i = 0; i < 30; ++i) {
        std::vector<float> increments(response_width);
        for (float& x : increments) x = normal(random);  // many are negative, as after a large step
        device.for_each_index(3, keep_rising{increments.data()});
        for (unsigned c = 0; c < 3; ++c) {
            const float* own = increments.data() + response_at(c, 0);
            CHECK(respond(0.0f, own) == 0);
            CHECK(respond(1.0f, own) == doctest::Approx(1).epsilon(1e-6));
            float sum = 0;
            for (unsigned k = 0; k < response_degree; ++k) sum += own[k];
            CHECK(sum == doctest::Approx(1).epsilon(1e-6));
            for (int step = 1; step <= 100; ++step) {
                const float x = static_cast<float>(step) / 100;
                CHECK(respond(x, own) > respond(x - 0.01f, own));
            }
        }
    }
    for (int step = 0; step <= 100; ++step) {
        const float x = static_cast<float>(step) / 100;
        CHECK(respond(x, equal_increments.data()) == doctest::Approx(x).epsilon(1e-6));
    }
}

TEST_CASE("response: colors beyond the range are shown as its ends, and can only be drawn back") {
    const std::vector<float> render{-0.5f, 1.5f, -2, 3, 0, 1, -0.1f, 1.1f, 0.5f, 0, 1, 0.5f};
    const std::vector<float> result = shown_with(render, some_increments);
    const std::vector<float> up(render.size(), -1.0f), down(render.size(), 1.0f);  // gradients descend
    const backward_result rises = response_gradients(4, 1, render, some_increments, up),
                          falls = response_gradients(4, 1, render, some_increments, down);
    for (std::size_t i = 0; i < render.size(); ++i) {
        CAPTURE(render[i]);
        const unsigned c = static_cast<unsigned>(i / 4);
        CHECK(result[i] ==
              doctest::Approx(curve_in_doubles(static_cast<double>(render[i]),
                                               {some_increments.begin(), some_increments.end()}, i / 4)));
        const float slope_at_zero = 5 * some_increments[response_at(c, 0)],
                    slope_at_one = 5 * some_increments[response_at(c, 4)];
        if (render[i] < 0) {
            CHECK(rises.by_render[i] == doctest::Approx(-slope_at_zero));
            CHECK(falls.by_render[i] == 0);
        } else if (render[i] > 1) {
            CHECK(rises.by_render[i] == 0);
            CHECK(falls.by_render[i] == doctest::Approx(slope_at_one));
        } else {
            CHECK(rises.by_render[i] < 0);
            CHECK(falls.by_render[i] > 0);
        }
    }
    // Ends are the same for all curves.
    const std::vector<float> ends{-0.5f, 1.5f, 0, 1, 3, -2};
    for (const double by :
         response_gradients(2, 1, ends, some_increments, std::vector<float>(6, 1.0f)).by_increment)
        CHECK(std::abs(by) < 1e-6);
}

TEST_CASE("response: a step without room, or whose gradient is not finite, leaves the curve") {
    cpu device;
    responses<cpu> cameras(device);
    cameras.set(some_increments);
    const std::vector<float> render(36, 0.5f), nothing(36, std::numeric_limits<float>::quiet_NaN());
    const auto learn = [&](const std::vector<float>& gradient, const gs::raster::list_capacity& capacity) {
        cameras.learn(0, render.data(), gradient.data(), {4, 3}, 0.1f, capacity);
    };
    const auto is_unchanged = [&] {
        const std::vector<float> now = cameras.get();
        return std::ranges::equal(now, some_increments,
                                  [](float a, float b) { return std::abs(a - b) < 1e-6f; });
    };
    const std::uint64_t required = 2;
    learn(render, {&required, 1});
    CHECK(is_unchanged());
    learn(nothing, {});
    CHECK(is_unchanged());
    for (int i = 0; i < 50; ++i) learn(render, {&required, 2});
    const std::vector<float> learned = cameras.get();
    const std::vector<double> before(some_increments.begin(), some_increments.end()),
        after(learned.begin(), learned.end());
    for (std::size_t c = 0; c < 3; ++c)
        CHECK(curve_in_doubles(0.5, after, c) < curve_in_doubles(0.5, before, c) - 0.05);
    for (const float x : learned) CHECK(x >= 0.5f * keep_rising::least);
}

TEST_CASE("response: photos with alpha and panoramas do not get it") {
    gs::scene scene;
    scene.train.emplace_back().camera = {600, 400, 500, 500, 300, 200};
    scene.train.emplace_back().camera = gs::camera::panorama(600, 300);
    const response_values values(response_feature().neutral_values(scene), 2);
    CHECK(values.lens_of_view == std::vector{0, -1});
    CHECK(values.parameters == equal_increments);
    CHECK(response_feature().obstacle(scene, {}).empty());
    scene.has_alpha = true;
    CHECK(response_feature().obstacle(scene, {}) ==
          "photos have transparent parts, whose background has no response");
    scene.has_alpha = false;
    scene.train = {scene.train[1]};
    CHECK(response_feature().obstacle(scene, {}) ==
          "all photos are panoramas, which are put together from several photos");
}

TEST_CASE("response: held-out and training views are shown with the curve of their lens, after exposures") {
    const gs::scene scene = small_scene("synthetic:spheres,response=0.5", 48);
    const response_feature feature;
    for (const auto make : engines()) {
        const auto e = make();
        response_values values(feature.neutral_values(scene), scene.train.size());
        values.parameters = some_increments;
        std::vector<exposure> brighter(scene.train.size(), identity_exposure);
        for (exposure& x : brighter) x[exposure_at(0, 0)] = 1.3f;
        const auto o = options_with(
            {{"exposure", true, "", flattened(brighter)}, {"response", true, "", values.flattened()}}, 1);
        e->set_views(scene.train, scene.test);
        e->set_model(gs::from_points(scene.points, 0, 1000, 1));
        const gs::train::training training(*e, scene, o, no_events);
        CHECK(e->feature("response").values() == values.flattened());
        std::vector<float> plain, curved;
        e->measure(1, {}, &plain);
        e->feature("exposure")
            .set_held_out_values(flattened(std::vector<exposure>(scene.test.size(), brighter[0])));
        feature.before_evaluation(*e, scene);
        e->measure(1, {}, &curved);
        o.features.show_on_host(*e, scene)(0, {48, 48}, plain);
        double largest = 0;
        for (std::size_t i = 0; i < plain.size(); ++i)
            largest = std::max(largest, static_cast<double>(std::abs(plain[i] - curved[i])));
        CHECK(largest < 1e-6);
        e->feature("exposure").set_held_out_values({});
        e->feature("response").set_held_out_values({});
        e->measure(1, {}, &plain);
        largest = 0;
        for (std::size_t i = 0; i < plain.size(); ++i)
            largest = std::max(largest, static_cast<double>(std::abs(plain[i] - curved[i])));
        CHECK(largest > 0.02);
    }
}

TEST_CASE("response: a training learns the curve, with equal bits each time") {
    const gs::scene scene = small_scene("synthetic:spheres,exposure=0.5,response=0.8,views=16", 24);
    for (const auto make : engines()) {
        const std::vector<selected_feature> both{exposure_in(scene), response_on(scene)};
        const auto on = trained_with(make, scene, both, 120, gs::accumulator::fixed),
                   again = trained_with(make, scene, both, 120, gs::accumulator::fixed);
        CHECK(on.increments == again.increments);
        CHECK(on.model.mean == again.model.mean);
        // The curve is steepest in the middle.
        for (unsigned c = 0; c < 3; ++c)
            CHECK(on.increments[response_at(c, 2)] > on.increments[response_at(c, 0)]);
    }
}

TEST_CASE("response: black and white photos, and photos without exposure, keep all values finite") {
    for (const char* parameters : {"black", "white", "halves"}) {
        CAPTURE(std::string(parameters));
        gs::scene scene = small_scene("synthetic:spheres,views=6", 24);
        for (std::size_t v = 0; v < scene.train.size(); ++v) {
            const bool white = parameters[0] == 'w' || (parameters[0] == 'h' && v % 2 == 0);
            std::ranges::fill(scene.train[v].pixels.rgba, std::uint8_t{255});
            if (!white)
                for (std::size_t i = 0; i < scene.train[v].pixels.rgba.size(); ++i)
                    if (i % 4 != 3) scene.train[v].pixels.rgba[i] = 0;
        }
        CHECK(response_feature().analyze(gs::scene_statistics(scene)).recommended != true);
        for (const auto make : engines()) {
            std::vector<exposure> exposures(scene.train.size(), identity_exposure);
            exposures[0] = {};
            const response_run run = trained_with(
                make, scene, {{"exposure", true, "", flattened(exposures)}, response_on(scene)}, 60);
            CHECK(std::isfinite(run.psnr));
            for (const float x : run.increments) CHECK((x > 0 && x < 1));
            for (const float x : run.model.mean) CHECK(std::isfinite(x));
        }
    }
}

TEST_CASE("response: the file has samples of the curves of each lens") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    const gs_test::temporary_folder folder;
    const auto e = gs::train::make_cpu_engine();
    response_values values(response_feature().neutral_values(scene), scene.train.size());
    values.parameters = some_increments;
    const auto o = options_with({{"response", true, "", values.flattened()}}, 1);
    e->set_views(scene.train, scene.test);
    e->set_model(gs::from_points(scene.points, 0, 100, 1));
    const gs::train::training training(*e, scene, o, no_events);
    o.features.write_results(*e, scene, folder.path());
    const auto lens = nlohmann::json::parse(std::ifstream(folder / "response.json")).at("lenses").at(0);
    CHECK(lens.at("photos") == scene.train.size());
    CHECK(lens.at("width") == 24);
    const auto& blue = lens.at("response").at("blue");
    REQUIRE(blue.size() == 21);
    CHECK(blue.at(0) == 0);
    CHECK(blue.at(20) == doctest::Approx(1));
    CHECK(blue.at(5).get<double>() ==
          doctest::Approx(curve_in_doubles(0.25, {some_increments.begin(), some_increments.end()}, 2)));
    feature_set({{"response", false, "", {}}}).write_results(*e, scene, folder.path());
    CHECK_FALSE(std::filesystem::exists(folder / "response.json"));
}

TEST_CASE("response: the curve of synthetic scenes rises from 0 to 1 and is the identity without strength") {
    gs::synthetic_parameters how;
    CHECK(gs::synthetic_response(how, 0.3) == doctest::Approx(0.3));
    how.response = 0.8;
    CHECK(gs::synthetic_response(how, -1) == 0);
    CHECK(gs::synthetic_response(how, 2) == doctest::Approx(1));
    CHECK(gs::synthetic_response(how, 0.5) == doctest::Approx(0.5));
    CHECK(gs::synthetic_response(how, 0.25) == doctest::Approx(0.2 * 0.25 + 0.4 * (1 - std::sqrt(0.5))));
    CHECK_THROWS_WITH_AS(response_in("alpha,response=0.4"), doctest::Contains("it has no response"),
                         gs::error);
    CHECK_THROWS_AS(response_in("spheres,response=0.4,panorama=1"), gs::error);
}

TEST_CASE("response: detection finds the curve if exposures differ") {
    CHECK(response_in("spheres,response=0.8,exposure=0.5,noise=0.02").recommended == true);
    CHECK(response_in("spheres,exposure=0.5,noise=0.02").recommended == false);
    const finding equal = response_in("spheres,response=0.8");
    CHECK(equal.recommended == false);
    CHECK(equal.evidence == "the brightness of photos does not differ enough to show a response");
    CHECK(response_in("spheres,response=0.8,exposure=0.5,points=40,views=8").recommended == std::nullopt);
}

TEST_CASE("response: the chart shows a curve that is flat at its end if the photos have one") {
    gs::load_options o;
    o.data = "synthetic:spheres,response=0.8,exposure=0.5";
    const gs::scene scene = gs::load_scene(o, {});
    const gs::scene_statistics statistics(scene);
    const response_feature feature;
    const explanation made = feature.explain(statistics, feature.analyze(statistics));
    CHECK(made.condition.find("at least 1.0 %") != std::string::npos);
    REQUIRE(made.charts.size() == 1);
    REQUIRE(made.charts[0].curves.size() == 2);
    const auto& points = made.charts[0].curves[0].points;
    REQUIRE(points.size() == 21);
    CHECK(points[20].second == doctest::Approx(100));
    const auto exponent = [&](std::size_t i) {  // of the power that is the curve around this sample
        return std::log(points[i + 1].second / points[i - 1].second) /
               std::log(points[i + 1].first / points[i - 1].first);
    };
    // The S is flat where colors saturate, and so is not a power.
    CHECK(exponent(8) > exponent(17) + 0.1);
}

TEST_CASE("long: response: detection decides right on scenes with many causes of different brightness") {
    for (const char* scene :
         {"spheres,response=0.5,exposure=0.5", "spheres,response=0.8,exposure=0.3,noise=0.03",
          "spheres,response=0.8,exposure=0.5,gloss=1", "spheres,response=0.8,exposure=0.5,vignetting=0.4",
          "spheres,response=0.8,exposure=0.5,sky=0.8,gloss=0.5",
          "spheres,response=1,exposure=0.5,walls=0.8"}) {
        CAPTURE(std::string(scene));
        CHECK(response_in(scene).recommended == true);
    }
    for (const char* scene :
         {"spheres", "spheres,exposure=0.5", "spheres,exposure=0.3,gloss=1", "spheres,exposure=1",
          "spheres,exposure=0.5,vignetting=0.5,noise=0.03", "spheres,exposure=0.5,scales=4",
          "spheres,exposure=0.5,moving=0.5", "spheres,exposure=0.5,walls=0.8,noise=0.05",
          "spheres,exposure=0.5,poses=1", "spheres,exposure=0.5,blur=8", "spheres,exposure=0.5,fisheye=60",
          "spheres,gloss=1,response=0.8", "alpha,exposure=0.5"}) {
        CAPTURE(std::string(scene));
        CHECK(response_in(scene).recommended != true);
    }
}

TEST_CASE("long: response: a training with it comes close to that of photos without a response") {
    const gs::scene clean = small_scene("synthetic:spheres,exposure=0.5", 48),
                    curved = small_scene("synthetic:spheres,exposure=0.5,response=0.8", 48);
    for (const auto make : engines()) {
        std::array<double, 4> mean{};
        for (const std::uint64_t seed : {0, 1}) {
            const auto run = [&](const gs::scene& scene, bool learns) {
                std::vector<selected_feature> selected{exposure_in(scene)};
                if (learns) selected.push_back(response_on(scene));
                return trained_with(make, scene, selected, 1500, gs::accumulator::native, seed).psnr;
            };
            mean[0] += run(clean, false) / 2;
            mean[1] += run(clean, true) / 2;
            mean[2] += run(curved, false) / 2;
            mean[3] += run(curved, true) / 2;
        }
        CAPTURE(mean);
        CHECK(mean[1] > mean[0] - 0.3);
        CHECK(mean[3] > mean[2] + 1);
        CHECK(std::abs(mean[3] - mean[0]) < std::abs(mean[2] - mean[0]));
    }
}
