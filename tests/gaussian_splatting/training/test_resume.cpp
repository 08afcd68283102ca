// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "check_equal.hpp"
#include "engines.hpp"
#include "features/depth/depth_feature.hpp"
#include "features/exposure/exposure_feature.hpp"
#include "features/motion/motion_feature.hpp"
#include "features/poses/poses_feature.hpp"
#include "features/response/response_feature.hpp"
#include "features/sh_degree/sh_degree_feature.hpp"
#include "features/vignetting/vignetting_feature.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

/// Initial values of poses that differ from the given ones.
std::vector<float> moved_poses(const gs::scene& scene) {
    using namespace gs::features;
    std::vector<pose_start> starts(scene.train.size(), pose_start{{0.01f, 0, 0, 0, 0, 0.02f}});
    starts.front() = {{0, 0.02f, 0, 0.03f, 0, 0}, step_from_corrected};
    return initial_values(given_poses(scene), starts);
}

/// The options of a short deterministic run in which all that can change changes: the number of
/// Gaussians, opacities, image size, SH degree, exposures, learned background, background color.
gs::train::train_options options_for(const gs::scene& scene, const std::string& strategy) {
    gs::train::train_options o;
    o.schedule.iterations = 80;
    o.schedule.sh_degree_interval = 10;
    o.densification.name = strategy;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 10;
    adaptive.densification_interval = 15;
    adaptive.densify_until_iter = 70;
    adaptive.opacity_reset_interval = 30;
    adaptive.densify_grad_threshold = 1e-5;
    o.max_cap = 2000;
    o.gradient = gs::accumulator::fixed;
    o.background.random = true;
    o.features = gs::features::feature_set(
        {{"direction", true, "", {1, 1}},  // revises the SH degree
         {"vignetting", true, "", gs::features::vignetting_feature().neutral_values(scene)},
         {"exposure", true, "", gs::features::exposure_feature().neutral_values(scene)},
         {"response", true, "", gs::features::response_feature().neutral_values(scene)},
         {"poses", true, "", moved_poses(scene)},
         {"motion", true, "", gs::features::motion_feature().neutral_values(scene)},
         {"moving", true, "", {}},
         {"depth", true, "", gs::features::depth_feature().neutral_values(scene)}});
    return o;
}

/// Trains a new engine, and stores a checkpoint of each iteration in `checkpoints`.
gs::gaussians trained(make_engine make, const gs::scene& scene, gs::train::train_options o,
                      std::map<int, gs::state_archive>& checkpoints) {
    const auto engine = make();
    engine->set_views(scene.train, {}, o.schedule.num_downscales);
    gs::gaussians model = gs::from_points(scene.points, 1, 300, 1);
    model.sky.assign(gs::sky_width, 0.0f);
    engine->set_model(model);
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    events.checkpoint = [&](int iteration, gs::state_archive& archive) {
        checkpoints.insert_or_assign(iteration, gs::state_archive(archive.values(), archive.arrays()));
    };
    gs::train::train(*engine, scene, o, events);
    return engine->get_model();
}

}  // namespace

TEST_CASE("resume: a run that continues from any checkpoint gives the same model bit for bit") {
    const gs::scene scene = small_scene("synthetic:spheres,depths=0.02,vignetting=0.4", 24);
    using iterations = std::vector<int>;
    using enum gs::train::moment_precision;
    for (const auto make : engines())
        for (const auto& [strategy, precision, last, resumed] :
             {std::tuple("adaptive", full, 80, iterations{14, 31, 45, 79}),
              std::tuple("mcmc", full, 130, iterations{99, 100}),
              std::tuple("adaptive", compact, 80, iterations{31, 50})}) {
            CAPTURE(std::string(strategy));
            gs::train::train_options o = options_for(scene, strategy);
            o.storage.precision = precision;
            o.schedule.iterations = last;
            o.checkpoint_every = 1;
            std::map<int, gs::state_archive> checkpoints, ignored;
            const gs::gaussians uninterrupted = trained(make, scene, o, checkpoints);
            CHECK(uninterrupted.count() > 350);
            REQUIRE(checkpoints.size() == static_cast<std::size_t>(last));
            for (const int iteration : resumed) {
                CAPTURE(iteration);
                gs::train::train_options rest = o;
                rest.checkpoint_every.reset();
                rest.resume_from = &checkpoints.at(iteration);
                rest.storage.first_degree_on_host = 2;
                CHECK(gs::train::precision_in(checkpoints.at(iteration)) == precision);
                check_equal(trained(make, scene, rest, ignored), uninterrupted);
            }
        }
}

TEST_CASE(
    "resume: learned poses belong to the starts of the checkpoint, also if a run would begin elsewhere") {
    const gs::scene scene = small_scene("synthetic:spheres,views=24", 24);
    gs::train::train_options o = options_for(scene, "adaptive");
    o.checkpoint_every = 10;
    std::map<int, gs::state_archive> checkpoints, ignored;
    const gs::gaussians uninterrupted = trained(gs::train::make_cpu_engine, scene, o, checkpoints);
    auto features = o.features.all();
    std::ranges::find(features, "poses", &gs::features::selected_feature::name)->values =
        gs::features::poses_feature().neutral_values(scene);
    gs::train::train_options rest = o;
    rest.features = gs::features::feature_set(features);
    rest.resume_from = &checkpoints.at(10);
    check_equal(trained(gs::train::make_cpu_engine, scene, rest, ignored), uninterrupted);
}

TEST_CASE("resume: a checkpoint of a resumed run equals that of the uninterrupted run") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o = options_for(scene, "adaptive");
    o.checkpoint_every = 25;
    std::map<int, gs::state_archive> first, second;
    trained(gs::train::make_cpu_engine, scene, o, first);
    o.resume_from = &first.at(25);
    trained(gs::train::make_cpu_engine, scene, o, second);
    const gs::state_archive &a = first.at(80), &b = second.at(80);
    REQUIRE(a.arrays().size() == b.arrays().size());
    for (const auto& [name, array] : a.arrays()) {
        CAPTURE(name);
        CHECK(b.arrays().at(name).bytes == array.bytes);
    }
    for (const auto& [name, value] : a.values()) {
        CAPTURE(name);
        if (name.ends_with("seconds")) continue;
        CHECK(b.values().at(name) == value);
    }
}

TEST_CASE("resume: an interruption makes a checkpoint after the iteration and ends the run") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    const gs::train::train_options o = options_for(scene, "adaptive");
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, {}, o.schedule.num_downscales);
    engine->set_model(gs::from_points(scene.points, 1, 300, 1));
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    int calls = 0, checkpoint_of = 0;
    events.is_interrupted = [&] { return ++calls == 33; };
    events.checkpoint = [&](int iteration, gs::state_archive&) { checkpoint_of = iteration; };
    CHECK(gs::train::train(*engine, scene, o, events).iterations == 33);
    CHECK(checkpoint_of == 33);
}

TEST_CASE("resume: other iterations, image sizes, features and SH degrees are allowed") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o = options_for(scene, "adaptive");
    o.checkpoint_iterations = {50};
    std::map<int, gs::state_archive> checkpoints, ignored;
    trained(gs::train::make_cpu_engine, scene, o, checkpoints);
    o.resume_from = &checkpoints.at(50);
    o.schedule.iterations = 90;
    SUBCASE("more iterations") {}
    SUBCASE("without exposures and depths") {
        o.features = gs::features::feature_set({{"direction", true, "", {1, 1}}});
    }
    SUBCASE("another strategy") { o.densification.name = "mcmc"; }
    SUBCASE("photos that are never halved") { o.schedule.num_downscales = 0; }
    SUBCASE("a lower SH degree") {
        o.features = gs::features::feature_set({gs::features::explicit_sh_degree(0)});
        CHECK(trained(gs::train::make_cpu_engine, scene, o, ignored).sh_degree == 0);
    }
    SUBCASE("a higher SH degree") {
        o.features = gs::features::feature_set({gs::features::explicit_sh_degree(3)});
        CHECK(trained(gs::train::make_cpu_engine, scene, o, ignored).sh_degree == 3);
    }
    const gs::gaussians model = trained(gs::train::make_cpu_engine, scene, o, ignored);
    CHECK(model.count() >= 300);
    gs::scene larger = small_scene("synthetic:spheres", 28);
    CHECK(trained(gs::train::make_cpu_engine, larger, o, ignored).count() >= 300);
}

TEST_CASE("resume: a checkpoint of other photos or of a later iteration is refused") {
    gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o = options_for(scene, "adaptive");
    o.checkpoint_iterations = {50};
    std::map<int, gs::state_archive> checkpoints;
    trained(gs::train::make_cpu_engine, scene, o, checkpoints);
    o.resume_from = &checkpoints.at(50);
    const auto problem = [&] {
        return gs_test::error_of([&] { trained(gs::train::make_cpu_engine, scene, o, checkpoints); });
    };
    SUBCASE("a later iteration") {
        o.schedule.iterations = 40;
        CHECK(problem() ==
              "the checkpoint is from iteration 50, after the last iteration 40: raise --iterations");
    }
    SUBCASE("a photo is missing") {
        const std::string name = scene.train[2].name, next = scene.train[3].name;
        scene.train.erase(scene.train.begin() + 2);
        o.features = options_for(scene, "adaptive").features;
        CHECK(gs_test::says(problem(), {"photo 3 was \"" + name + "\" and is \"" + next + "\""}));
    }
    SUBCASE("a camera has moved") {
        scene.normalization.origin.x += 1e-9;
        CHECK(gs_test::says(problem(), {"cameras", "have changed", "--overwrite"}));
    }
}

TEST_CASE("resume: values that no training writes are refused") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o = options_for(scene, "adaptive");
    o.checkpoint_iterations = {50};
    std::map<int, gs::state_archive> checkpoints, ignored;
    trained(gs::train::make_cpu_engine, scene, o, checkpoints);
    const gs::state_archive& good = checkpoints.at(50);
    const auto refuses = [&](const gs::state_archive::value_map& values,
                             const gs::state_archive::array_map& arrays) {
        gs::state_archive wrong(values, arrays);
        o.resume_from = &wrong;
        return !gs_test::error_of([&] { trained(gs::train::make_cpu_engine, scene, o, ignored); }).empty();
    };
    CHECK_FALSE(refuses(good.values(), good.arrays()));
    for (const auto& [name, value] :
         std::map<std::string, std::string>{{"engine.gaussians", "5"},
                                            {"engine.sh_degree", "7"},
                                            {"engine.sh_degree", "-1"},
                                            {"engine.first_moments.gaussians_with_sh", "0"},
                                            {"engine.list_capacity", "99999999999"},
                                            {"direction.degree", "9"},
                                            {"training.iteration", "-5"},
                                            {"training.reports", std::string(100000, '[')},
                                            {"next_view", "1000000000000"},
                                            {"random_views", "junk"}}) {
        CAPTURE(name);
        auto values = good.values();
        REQUIRE(values.contains(name));
        values[name] = value;
        CHECK(refuses(values, good.arrays()));
    }
    for (const char* name : {"views", "engine.counts", "engine.lengths", "engine.statistics",
                             "engine.last_step", "engine.values.mean", "engine.exposure.values"}) {
        CAPTURE(std::string(name));
        auto arrays = good.arrays();
        REQUIRE(arrays.contains(name));
        arrays.at(name).bytes.clear();
        CHECK(refuses(good.values(), arrays));
    }
    auto arrays = good.arrays();
    std::ranges::fill(arrays.at("views").bytes, std::byte{0x7f});
    CHECK(refuses(good.values(), arrays));
}

TEST_CASE("resume: a run that continues at its last iteration saves the model") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o = options_for(scene, "adaptive");
    o.checkpoint_iterations = {50};
    std::map<int, gs::state_archive> checkpoints;
    trained(gs::train::make_cpu_engine, scene, o, checkpoints);
    o.resume_from = &checkpoints.at(50);
    o.schedule.iterations = 50;
    o.save_iterations = {50};
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, {}, o.schedule.num_downscales);
    engine->set_model(gs::from_points(scene.points, 1, 300, 1));
    std::vector<int> saved;
    const gs::train::train_events events{[](const gs::train::progress&) {},
                                         [&](int iteration) { saved.push_back(iteration); }, [](int) {}};
    gs::train::train(*engine, scene, o, events);
    CHECK(saved == std::vector{50});
}
