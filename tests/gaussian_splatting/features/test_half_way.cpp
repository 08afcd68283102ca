// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../training/check_equal.hpp"
#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"  // before kernels, which call functions of its SIMD values
#include "features/exposure/exposure_feature.hpp"
#include "features/half_way/half_way_statistics.hpp"
#include "features/resolve.hpp"
#include "features/response/response_feature.hpp"
#include "features/vignetting/vignetting_feature.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

using namespace gs::features;

namespace {

const selected_feature undecided_vignetting{"vignetting", false, "", {}, true};

gs::train::train_options options_with(std::vector<selected_feature> selected, int iterations) {
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    o.max_cap = 3000;
    o.gradient = gs::accumulator::fixed;
    o.features = feature_set(std::move(selected));
    return o;
}

struct training_run {
    gs::train::train_result result;
    std::vector<float> falloff, response;  ///< values at the end
    std::vector<std::string> lines;        ///< for the user
    gs::gaussians model;
    std::map<int, gs::state_archive> checkpoints;
};

training_run trained(make_engine make, const gs::scene& scene, const gs::train::train_options& o) {
    const auto e = make();
    e->set_views(scene.train, {}, o.schedule.num_downscales);
    gs::gaussians model = gs::from_points(scene.points, 0, 3000, 1);
    model.antialiased = true;
    model.sky.assign(gs::sky_width, 0.0f);
    e->set_model(model);
    training_run run;
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    events.say = [&](const std::string& line) { run.lines.push_back(line); };
    events.checkpoint = [&](int iteration, gs::state_archive& archive) {
        run.checkpoints.insert_or_assign(iteration, gs::state_archive(archive.values(), archive.arrays()));
    };
    run.result = gs::train::train(*e, scene, o, events);
    run.falloff = e->feature("vignetting").values();
    run.response = e->feature("response").values();
    run.model = e->get_model();
    return run;
}

/// The brightness in the corners relative to the center, for green.
double in_corners(const std::vector<float>& values, const gs::scene& scene) {
    const falloff_values learned(values, scene.train.size());
    double sum = 1;
    for (unsigned k = 0; k < falloff_terms; ++k) sum += static_cast<double>(learned.of(0)[falloff_at(1, k)]);
    return 1 / sum;
}

selected_feature outcome(const gs::scene& scene, const char* selection, const std::string& name) {
    const feature_set features = resolve(scene, parse_selection(selection));
    return *std::ranges::find(features.all(), name, &selected_feature::name);
}

}  // namespace

TEST_CASE("half way: an effect may begin unless the user or the scene excludes it") {
    const gs::scene plain = small_scene(), exposed = small_scene("synthetic:spheres,exposure=0.4"),
                    transparent = small_scene("synthetic:alpha");
    CHECK(outcome(plain, "auto", "vignetting").may_begin);
    CHECK(outcome(plain, "auto,-direction", "vignetting").may_begin);
    for (const char* selection : {"auto,-vignetting", "auto,+vignetting", "none", "all", "exposure"})
        CHECK_FALSE(outcome(plain, selection, "vignetting").may_begin);
    CHECK_FALSE(outcome(plain, "auto", "exposure").may_begin);
    CHECK_FALSE(outcome(transparent, "auto", "vignetting").may_begin);

    CHECK(outcome(exposed, "auto", "response").may_begin);
    CHECK_FALSE(outcome(exposed, "auto,-exposure", "response").may_begin);
    CHECK_FALSE(outcome(plain, "auto", "response").may_begin);

    feature_set features({undecided_vignetting});
    CHECK(features.may_begin("vignetting"));
    CHECK_FALSE(features.is_on("vignetting"));
    CHECK_FALSE(features.may_begin("response"));
}

TEST_CASE("half way: training begins a falloff that photos from different distances hide") {
    const gs::scene with = small_scene("synthetic:spheres,scales=5,sky=0.8,vignetting=0.4", 64),
                    without = small_scene("synthetic:spheres,scales=5,sky=0.8", 64);
    for (const auto make : engines()) {
        const training_run found = trained(make, with, options_with({undecided_vignetting}, 300));
        REQUIRE_FALSE(found.falloff.empty());
        const double corners = in_corners(found.falloff, with);
        CHECK(corners > 0.5);
        CHECK(corners < 0.75);
        const auto& report = found.result.feature_reports.at("vignetting");
        CHECK(report["on"] == true);
        CHECK(report["on_at_first"] == false);
        REQUIRE(found.lines.size() == 1);
        CHECK(found.lines[0].starts_with("vignetting on after iteration 150: the same parts"));
        CHECK(found.lines[0].ends_with(report["reason_half_way"].get<std::string>()));

        const training_run none = trained(make, without, options_with({undecided_vignetting}, 300));
        CHECK(none.falloff.empty());
        CHECK(none.result.feature_reports.at("vignetting")["on"] == false);
        REQUIRE(none.lines.size() == 1);
        CHECK(none.lines[0].starts_with("vignetting still off after iteration 150: "));
    }
}

TEST_CASE("half way: an effect that may not begin changes nothing and is not reported") {
    const gs::scene scene = small_scene("synthetic:spheres,sky=0.8,vignetting=0.4", 24);
    const training_run off =
        trained(gs::train::make_cpu_engine, scene, options_with({{"vignetting", false, "", {}}}, 60));
    CHECK(off.falloff.empty());
    CHECK(off.lines.empty());
    CHECK(off.result.feature_reports.empty());
    check_equal(off.model, trained(gs::train::make_cpu_engine, scene, options_with({}, 60)).model);
}

TEST_CASE("half way: a run that continues from a checkpoint keeps the decision, bit for bit") {
    const gs::scene scene = small_scene("synthetic:spheres,sky=0.8,vignetting=0.5", 32);
    gs::train::train_options o = options_with({undecided_vignetting}, 160);
    o.checkpoint_every = 20;
    for (const auto make : engines()) {
        const training_run whole = trained(make, scene, o);
        REQUIRE_FALSE(whole.falloff.empty());
        gs::train::train_options rest = o;
        rest.checkpoint_every.reset();
        for (const int iteration : {60, 80, 140}) {
            CAPTURE(iteration);
            gs::state_archive checkpoint = whole.checkpoints.at(iteration);
            rest.resume_from = &checkpoint;
            const training_run resumed = trained(make, scene, rest);
            check_equal(resumed.model, whole.model);
            CHECK(resumed.falloff == whole.falloff);
            CHECK(resumed.lines.size() == (iteration < 80 ? 1 : 0));
            CHECK(resumed.result.feature_reports.at("vignetting")["on"] == true);
        }
        gs::state_archive checkpoint = whole.checkpoints.at(140);
        gs::train::train_options without = options_with({{"vignetting", false, "--effects none"}}, 160);
        without.resume_from = &checkpoint;
        const training_run stopped = trained(make, scene, without);
        CHECK(stopped.falloff.empty());
        CHECK_FALSE(stopped.result.feature_reports.contains("vignetting"));
    }
}

TEST_CASE("long: half way: training begins a response that photos from different distances hide") {
    const gs::scene with = small_scene("synthetic:spheres,scales=5,exposure=0.4,response=0.9", 128),
                    without = small_scene("synthetic:spheres,scales=5,exposure=0.4", 128);
    const auto run = [](const gs::scene& scene) {
        return trained(gs::train::make_cpu_engine, scene,
                       options_with({{"exposure", true, "",
                                      exposure_feature().analyze(gs::scene_statistics(scene)).values},
                                     {"response", false, "", {}, true}},
                                    1000));
    };
    CHECK_FALSE(run(with).response.empty());
    CHECK(run(without).response.empty());
}
