// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "../training/check_equal.hpp"
#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"  // before kernels, which call functions of its SIMD values
#include "features/half_way/half_way_statistics.hpp"
#include "features/resolve.hpp"
#include "features/vignetting/vignetting_feature.hpp"
#include "scene/image_radius.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

using namespace gs::features;

namespace {

/// A scene whose cameras are at very different distances, so that few points can be compared. `scales`: ratio
/// of the largest distance to the smallest.
gs::scene scene_with_distances(int scales, const std::string& parameters, int side) {
    return small_scene(("synthetic:spheres,scales=" + std::to_string(scales) + parameters).c_str(), side);
}

gs::scene scene_with(const std::string& parameters, int side = 40) {
    return scene_with_distances(5, parameters, side);
}

gs::train::train_options reviewed_options(const gs::scene& scene, const char* effects, int iterations) {
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.max_cap = 3000;
    o.gradient = gs::accumulator::fixed;
    o.features = resolve(scene, parse_selection(effects));
    return o;
}

struct reviewed_run {
    gs::train::train_result result;
    std::vector<float> falloff, response, moving;  ///< values at the end
    std::vector<std::string> lines;                ///< for the user
    gs::gaussians model;
    std::map<int, gs::state_archive> checkpoints;
};

reviewed_run reviewed_training(make_engine make, gs::scene scene, const gs::train::train_options& o) {
    const auto e = make();
    gs::gaussians model = gs::from_points(scene.points, 0, 3000, 1);
    o.features.prepare(scene, model);
    e->set_views(scene.train, {}, o.schedule.num_downscales);
    e->set_model(model);
    reviewed_run run;
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    events.say = [&](const std::string& line) { run.lines.push_back(line); };
    events.checkpoint = [&](int iteration, gs::state_archive& archive) {
        run.checkpoints.insert_or_assign(iteration, gs::state_archive(archive.values(), archive.arrays()));
    };
    run.result = gs::train::train(*e, scene, o, events);
    run.falloff = e->feature("vignetting").values();
    run.response = e->feature("response").values();
    run.moving = e->feature("moving").values();
    run.model = e->get_model();
    return run;
}

/// The brightness in the corners relative to the center, for green.
double brightness_in_corners(const std::vector<float>& values, const gs::scene& scene) {
    const falloff_values learned(values, scene.train.size());
    double sum = 1;
    for (unsigned k = 0; k < falloff_terms; ++k) sum += static_cast<double>(learned.of(0)[falloff_at(1, k)]);
    return 1 / sum;
}

/// Cells that photos show at random places, darker toward corners by exp(-strength) and with this noise.
half_way_statistics cells_with_falloff(const gs::scene& scene, double strength, double noise) {
    std::mt19937 random(1);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    gs::observed_points cells(100);
    for (auto& seen : cells)
        for (std::uint32_t v = 0; v < scene.train.size(); ++v) {
            const gs::camera& c = scene.train[v].camera;
            gs::observation o;
            o.view = v;
            o.place = {uniform() * c.width, uniform() * c.height};
            o.direction = c.ray(o.place.x, o.place.y);
            o.footprint = 1;
            const double u = gs::square_radius(c, o.place.x, o.place.y);
            o.color =
                glm::vec3(glm::dvec3(0.5 * std::exp(-strength * u) * (1 + noise * (2 * uniform() - 1))));
            seen.push_back(o);
        }
    return {scene, {cells, {}, {}}};
}

selected_feature selected_in(const gs::scene& scene, const char* selection, const std::string& name) {
    const feature_set features = resolve(scene, parse_selection(selection));
    return *std::ranges::find(features.all(), name, &selected_feature::name);
}

}  // namespace

TEST_CASE("half way: an effect may begin unless the user or the scene excludes it") {
    const gs::scene plain = small_scene("synthetic:spheres", 24),
                    exposed = small_scene("synthetic:spheres,exposure=0.4", 24),
                    transparent = small_scene("synthetic:alpha", 24);
    CHECK(selected_in(plain, "auto", "vignetting").may_begin);
    CHECK(selected_in(plain, "auto,-direction", "vignetting").may_begin);
    for (const char* selection : {"auto,-vignetting", "auto,+vignetting", "none", "all", "exposure"})
        CHECK_FALSE(selected_in(plain, selection, "vignetting").may_begin);
    CHECK_FALSE(selected_in(plain, "auto", "exposure").may_begin);
    CHECK_FALSE(selected_in(transparent, "auto", "vignetting").may_begin);

    CHECK(selected_in(exposed, "auto", "response").may_begin);
    CHECK_FALSE(selected_in(exposed, "auto,-exposure", "response").may_begin);
    CHECK_FALSE(selected_in(plain, "auto", "response").may_begin);

    const feature_set features({{"vignetting", false, "", {}, true}});
    CHECK(features.may_begin("vignetting"));
    CHECK_FALSE(features.is_on("vignetting"));
    CHECK_FALSE(features.may_begin("response"));
}

TEST_CASE("half way: training begins a falloff that photos from different distances hide") {
    const gs::scene with = scene_with(",sky=0.8,vignetting=0.4"), without = scene_with(",sky=0.8");
    for (const auto make : engines()) {
        const reviewed_run found = reviewed_training(make, with, reviewed_options(with, "auto", 60));
        REQUIRE_FALSE(found.falloff.empty());
        const double corners = brightness_in_corners(found.falloff, with);
        CHECK(corners > 0.4);
        CHECK(corners < 0.8);
        const auto& report = found.result.feature_reports.at("vignetting");
        CHECK(report["on"] == true);
        CHECK(report["on_at_first"] == false);
        REQUIRE_FALSE(found.lines.empty());
        CHECK(found.lines[0].starts_with("vignetting on after iteration 30: the same parts"));
        CHECK(found.lines[0].ends_with(report["reason_half_way"].get<std::string>()));

        const reviewed_run none = reviewed_training(make, without, reviewed_options(without, "auto", 60));
        CHECK(none.falloff.empty());
        CHECK(none.result.feature_reports.at("vignetting")["on"] == false);
        REQUIRE_FALSE(none.lines.empty());
        CHECK(none.lines[0].starts_with("vignetting still off after iteration 30: "));
    }
}

TEST_CASE("half way: a weak falloff must be certain, because errors of the model look like one") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    const auto reviewed = [&](double strength, double noise) {
        return vignetting_feature().review(cells_with_falloff(scene, strength, noise));
    };
    for (const auto& [strength, noise, is_clear] :
         {std::tuple{0.3, 0.1, true}, {0.1, 0.02, true}, {0.1, 0.3, false}, {0.0, 0.02, false}}) {
        const finding found = reviewed(strength, noise);
        CAPTURE(found.evidence);
        CHECK(found.recommended == is_clear);
    }
}

TEST_CASE("half way: training finds moving things, also in photos from different distances") {
    for (const auto make : engines())
        for (const bool moves : {true, false}) {
            const gs::scene scene = scene_with_distances(8, moves ? ",moving=0.2" : "", 64);
            CHECK(selected_in(scene, "auto", "moving").may_begin);
            const reviewed_run run = reviewed_training(make, scene, reviewed_options(scene, "auto", 200));
            CHECK(run.moving.empty() == !moves);
            CHECK(run.result.feature_reports.at("moving")["on"] == moves);
            const std::string begin =
                std::string("moving ") + (moves ? "on" : "still off") + " after iteration 100: ";
            CHECK(std::ranges::any_of(run.lines, [&](const auto& line) { return line.starts_with(begin); }));
        }
}

TEST_CASE("half way: a run that continues from a checkpoint keeps the weights, bit for bit") {
    const gs::scene scene = scene_with_distances(8, ",moving=0.2", 64);
    REQUIRE(selected_in(scene, "auto", "moving").may_begin);
    gs::train::train_options o = reviewed_options(scene, "auto", 200);
    o.checkpoint_every = 50;
    for (const auto make : engines()) {
        const reviewed_run whole = reviewed_training(make, scene, o);
        REQUIRE_FALSE(whole.moving.empty());
        for (const int iteration : {50, 100, 150}) {
            CAPTURE(iteration);
            gs::train::train_options rest = reviewed_options(scene, "auto", 200);
            gs::state_archive checkpoint = whole.checkpoints.at(iteration);
            rest.resume_from = &checkpoint;
            const reviewed_run resumed = reviewed_training(make, scene, rest);
            check_equal(resumed.model, whole.model);
            CHECK(resumed.moving == whole.moving);
        }
    }
}

TEST_CASE("half way: an effect that the user has switched off changes nothing and is not reported") {
    const gs::scene scene = scene_with(",sky=0.8,vignetting=0.4", 24);
    const reviewed_run off =
        reviewed_training(gs::train::make_cpu_engine, scene, reviewed_options(scene, "auto,-vignetting", 40));
    CHECK(off.falloff.empty());
    CHECK(std::ranges::none_of(off.lines, [](const auto& line) { return line.starts_with("vignetting"); }));
    CHECK_FALSE(off.result.feature_reports.contains("vignetting"));
}

TEST_CASE("half way: a run that continues from a checkpoint keeps the decision, bit for bit") {
    const gs::scene scene = scene_with(",sky=0.8,vignetting=0.5");
    gs::train::train_options o = reviewed_options(scene, "auto", 60);
    o.checkpoint_every = 10;
    for (const auto make : engines()) {
        const reviewed_run whole = reviewed_training(make, scene, o);
        REQUIRE_FALSE(whole.falloff.empty());
        gs::train::train_options rest = o;
        rest.checkpoint_every.reset();
        for (const int iteration : {20, 30, 50}) {
            CAPTURE(iteration);
            gs::state_archive checkpoint = whole.checkpoints.at(iteration);
            rest.resume_from = &checkpoint;
            const reviewed_run resumed = reviewed_training(make, scene, rest);
            check_equal(resumed.model, whole.model);
            CHECK(resumed.falloff == whole.falloff);
            CHECK(resumed.lines.empty() == (iteration >= 30));
            CHECK(resumed.result.feature_reports.at("vignetting")["on"] == true);
        }
        gs::state_archive checkpoint = whole.checkpoints.at(50);
        gs::train::train_options without = reviewed_options(scene, "auto,-vignetting", 60);
        without.resume_from = &checkpoint;
        const reviewed_run stopped = reviewed_training(make, scene, without);
        CHECK(stopped.falloff.empty());
        CHECK_FALSE(stopped.result.feature_reports.contains("vignetting"));
    }
}

TEST_CASE("long: half way: training begins a response that photos from different distances hide") {
    const auto response_of = [](const std::string& parameters) {
        const gs::scene scene = scene_with(",exposure=0.4" + parameters, 128);
        const auto o = reviewed_options(scene, "auto", 1000);
        CHECK(o.features.may_begin("response"));
        return reviewed_training(gs::train::make_cpu_engine, scene, o).response;
    };
    CHECK_FALSE(response_of(",response=0.9").empty());
    CHECK(response_of("").empty());
}
