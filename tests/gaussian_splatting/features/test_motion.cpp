// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../training/engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/motion/motion_evidence.hpp"
#include "features/motion/motion_feature.hpp"
#include "features/resolve.hpp"
#include "readers/synthetic/synthetic_cameras.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

gs::scene synthetic_photos(const std::string& parameters) {
    gs::load_options o;
    o.data = "synthetic:" + parameters;
    return gs::load_scene(o, {});
}

/// Returns the true blur of each of the 48 photos, in pixels.
std::vector<glm::dvec2> true_blurs(double blur) {
    gs::synthetic_parameters how;
    how.blur = blur;
    std::vector<gs::view> views = gs::synthetic_views(gs::synthetic_size, how);
    gs::shake_cameras(views, how);
    std::vector<glm::dvec2> blurs;
    for (const gs::view& v : views)
        blurs.push_back(v.camera.motion
                            ? blur_of(v.camera, *v.camera.motion, glm::length(v.camera.translation))
                            : glm::dvec2(0));
    return blurs;
}

motion_evidence edges_of_scene(const std::string& parameters) {
    const gs::scene scene = synthetic_photos(parameters);
    return find_motion_blur(gs::scene_statistics(scene));
}

/// Trains with the motion of cameras, or without it if there are no initial values.
std::unique_ptr<gs::train::engine> trained_with(make_engine make, const gs::scene& scene,
                                                const std::vector<float>& initial,
                                                gs::accumulator sums = gs::accumulator::native,
                                                int iterations = 100) {
    auto e = make();
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    o.max_cap = 10000;
    o.gradient = sums;
    if (!initial.empty()) o.features = feature_set({{"motion", true, "", initial}});
    e->set_views(scene.train, scene.test, o.schedule.num_downscales);
    e->set_model(gs::from_points(scene.points, 0, 3000, 1));
    gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
    return e;
}

std::vector<float> neutral_motion(const gs::scene& scene) { return motion_feature().neutral_values(scene); }

double held_out_psnr(gs::train::engine& e, const gs::scene& scene) {
    return gs::evaluate::measure_held_out_views(e, scene, {}, {}).psnr();
}

}  // namespace

TEST_CASE("motion: values 0 and 1 move the image by a pixel, and a shift keeps the typical depth in place") {
    gs::camera c{640, 480, 500, 500, 320, 240};
    const motion_scale scale{4, 1 / 500.0};
    const gs::camera_motion turned = motion_of(scale, {-2, 3, 0, 0, 0, 0, 0});
    CHECK(blur_of(c, turned, 3).x == doctest::Approx(3));
    CHECK(blur_of(c, turned, 3).y == doctest::Approx(2));
    const gs::camera_motion shifted = motion_of(scale, {0, 0, 0, 5, -7, 0, 0});
    CHECK(glm::length(blur_of(c, shifted, scale.depth)) < 1e-9);
    CHECK(blur_of(c, shifted, 2).x == doctest::Approx(500 * shifted.shift.x / 4));
    CHECK(glm::length(shifted.shift) > 0.005);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const gs::camera_motion none = motion_of(scale, {1, nan, 0, 0, 0, 0, 0});
    CHECK(none.turn == glm::dvec3(0));
    CHECK(none.readout == 0);
}

TEST_CASE("motion: photos share the readout time, and those of the other sign move the other way") {
    std::vector<float> values{3, 0, 0, 0, 0, 0, 0.5f, 0, -1, 0, 0, 0, 0, -1.5f};
    share_readout(values);
    CHECK(values == std::vector<float>{3, 0, 0, 0, 0, 0, 0.6f, 0, 1, 0, 0, 0, 0, 0.6f});
    std::vector<float> still(14, 0.0f);
    share_readout(still);
    CHECK(still == std::vector<float>(14, 0.0f));
}

TEST_CASE("motion: detection finds direction and length of blurs, with which training begins") {
    gs::scene scene = synthetic_photos("spheres,blur=6");
    const motion_evidence evidence = find_motion_blur(gs::scene_statistics(scene));
    const finding found = motion_feature().analyze(gs::scene_statistics(scene));
    CHECK(found.recommended == true);
    REQUIRE(found.values.size() == 8 * scene.train.size());
    CHECK(evidence.judged() >= 40);
    CHECK(evidence.blurred() >= 8);
    const std::vector<glm::dvec2> truth = true_blurs(6);
    for (std::size_t v = 0; v < truth.size(); ++v) {
        CAPTURE(v);
        const photo_blur& photo = evidence.photos[v];
        const double length = std::hypot(static_cast<double>(found.values[8 * v + 2]),
                                         static_cast<double>(found.values[8 * v + 3]));
        CHECK(length == doctest::Approx(photo.is_clear() ? glm::length(photo.motion) : 0.5));
        if (!photo.is_clear()) continue;
        const glm::dvec2 motion = photo.motion;
        CHECK(std::min(glm::length(motion - truth[v]), glm::length(motion + truth[v])) < 2.5);
        CHECK(std::abs(glm::dot(motion, truth[v])) > 0.8 * glm::length(motion) * glm::length(truth[v]));
    }
    scene.train[7].camera.is_panorama = true;
    CHECK(motion_feature().analyze(gs::scene_statistics(scene)).recommended == false);
    CHECK(motion_feature().obstacle(scene, {}).find("panoramas") != std::string::npos);
}

TEST_CASE("motion: detection finds nothing in sharp photos, and is undecided without photos") {
    const gs::scene sharp = synthetic_photos("spheres");
    CHECK(motion_feature().analyze(gs::scene_statistics(sharp)).recommended == false);
    CHECK(motion_feature().analyze(gs::scene_statistics(gs::scene{})).recommended == std::nullopt);
}

TEST_CASE("long: motion: detection finds nothing in photos that are sharp, noisy or changed otherwise") {
    for (const char* scene :
         {"spheres,noise=0.03", "spheres,exposure=0.4,noise=0.03", "spheres,scales=4", "spheres,gloss=1",
          "spheres,moving=0.5", "spheres,passers=0.1", "spheres,walls=0.8", "spheres,shutter=6", "alpha",
          "alpha,scales=4", "alpha,noise=0.03"}) {
        CAPTURE(std::string(scene));
        CHECK_FALSE(edges_of_scene(scene).is_clear());
    }
    for (const char* scene : {"spheres,blur=4", "alpha,blur=6", "spheres,blur=6,noise=0.02",
                              "spheres,blur=8,shutter=6,exposure=0.3,gloss=0.5"}) {
        CAPTURE(std::string(scene));
        CHECK(edges_of_scene(scene).is_clear());
    }
}

TEST_CASE("motion: fixed-point sums give the same motions and cameras each time") {
    const gs::scene scene = small_scene("synthetic:spheres,blur=20", 32);
    for (const auto make : engines()) {
        const auto first = trained_with(make, scene, neutral_motion(scene), gs::accumulator::fixed);
        const auto second = trained_with(make, scene, neutral_motion(scene), gs::accumulator::fixed);
        const auto values = first->feature("motion").values();
        REQUIRE(values.size() == motion_width * scene.train.size());
        CHECK(values == second->feature("motion").values());
        CHECK(std::ranges::any_of(values, [](float x) { return std::abs(x) > 0.6f; }));
        CHECK(first->get_model().mean == second->get_model().mean);
        const gs::camera seen = first->cameras().training_camera(3, scene.train[3].camera);
        REQUIRE(seen.motion.has_value());
        CHECK(glm::length(seen.motion->turn) > 0);
    }
}

TEST_CASE("motion: without the effect, cameras keep still") {
    const gs::scene scene = small_scene("synthetic:spheres", 32);
    const auto e = gs::train::make_cpu_engine();
    e->set_views(scene.train, {}, 0);
    CHECK_FALSE(e->cameras().training_camera(2, scene.train[2].camera).motion.has_value());
    CHECK(e->feature("motion").values().empty());
}

TEST_CASE("motion: refinement finds motions of held-out photos, and keeps their poses") {
    const gs::scene scene = small_scene("synthetic:spheres,blur=8", 32);
    for (const auto make : engines()) {
        const auto e = trained_with(make, scene, neutral_motion(scene), gs::accumulator::native, 60);
        const gs::camera& given = scene.test[0].camera;
        const gs::camera refined = e->cameras().refined_camera(0, {});
        CHECK(refined.rotation == given.rotation);
        CHECK(refined.translation == given.translation);
        REQUIRE(refined.motion.has_value());
        CHECK(glm::length(refined.motion->turn) > 0);
    }
}

TEST_CASE("motion: the results are motions in world units, and a run without the effect removes them") {
    gs::scene scene = small_scene("synthetic:spheres,blur=20", 32);
    scene.normalization = {{10, 20, 30}, 2};
    const auto e =
        trained_with(gs::train::make_cpu_engine, scene, neutral_motion(scene), gs::accumulator::native, 30);
    const auto folder = std::filesystem::temp_directory_path() / "warpagg_test_motion";
    std::filesystem::create_directories(folder);
    const selected_feature on{"motion", true, "", {}}, off{"motion", false, "", {}};
    motion_feature().write_results(on, *e, scene, folder);
    const auto json = nlohmann::json::parse(std::ifstream(folder / "motion.json"));
    CHECK(json.size() == scene.train.size());
    const auto& one = json.at(scene.train[5].name);
    const gs::camera seen = e->cameras().training_camera(5, scene.train[5].camera);
    CHECK(one.at("blur")[0].get<double>() ==
          doctest::Approx(blur_of(seen, *seen.motion, motion_scales(scene)[5].depth).x));
    CHECK(one.at("shift")[1].get<double>() == doctest::Approx(2 * seen.motion->shift.y));
    CHECK(one.at("readout").get<double>() == doctest::Approx(seen.motion->readout));
    motion_feature().write_results(off, *e, scene, folder);
    CHECK_FALSE(std::filesystem::exists(folder / "motion.json"));
    std::filesystem::remove_all(folder);
}

TEST_CASE("long: motion: training recovers blurred photos, and loses little with sharp ones") {
    const gs::scene sharp = small_scene("synthetic:spheres", 128),
                    blurred = small_scene("synthetic:spheres,blur=6", 128);
    for (const auto make : engines()) {
        const auto run = [&](const gs::scene& scene, const std::vector<float>& initial, int iterations) {
            return held_out_psnr(*trained_with(make, scene, initial, gs::accumulator::native, iterations),
                                 scene);
        };
        const finding found = motion_feature().analyze(gs::scene_statistics(blurred));
        const double without = run(blurred, {}, 3500), with = run(blurred, found.values, 3500);
        CAPTURE(without);
        CAPTURE(with);
        CHECK(with > without + 0.4);
        const double still = run(sharp, {}, 1500), forced = run(sharp, neutral_motion(sharp), 1500);
        CAPTURE(still);
        CAPTURE(forced);
        CHECK(forced > still - 0.35);
    }
}

TEST_CASE("long: motion: training corrects rolling shutters") {
    const gs::scene scene = small_scene("synthetic:spheres,shutter=8", 128);
    for (const auto make : engines()) {
        const double without =
            held_out_psnr(*trained_with(make, scene, {}, gs::accumulator::native, 1500), scene);
        const auto e = trained_with(make, scene, neutral_motion(scene), gs::accumulator::native, 1500);
        const double with = held_out_psnr(*e, scene);
        CAPTURE(without);
        CAPTURE(with);
        CHECK(with > without + 0.2);
    }
}

TEST_CASE("long: motion: refinement finds the motion of a held-out photo") {
    gs::scene scene = small_scene("synthetic:spheres", 128);
    const gs::scene blurred = synthetic_photos("spheres,blur=8");
    // Photo 21 of all is held out, and its camera moves.
    const std::size_t held_out = 3;
    REQUIRE(scene.test[held_out].name == "view_21.png");
    scene.test = {scene.test[held_out]};
    scene.test[0].pixels = blurred.train[21].pixels;
    for (const auto make : engines()) {
        const auto e = trained_with(make, scene, neutral_motion(scene), gs::accumulator::native, 1000);
        const gs::camera refined = e->cameras().refined_camera(0, {});
        REQUIRE(refined.motion.has_value());
        const glm::dvec2 found = blur_of(refined, *refined.motion, motion_scales(scene)[0].depth),
                         truth = true_blurs(8)[21];
        CAPTURE(found.x);
        CAPTURE(found.y);
        CHECK(std::min(glm::length(found - truth), glm::length(found + truth)) < 0.5 * glm::length(truth));
    }
}
