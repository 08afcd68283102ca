// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "../training/engines.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "device/cpu/cpu.hpp"  // before kernels, which call functions of its SIMD values
#include "features/poses/poses_feature.hpp"
#include "features/resolve.hpp"
#include "scene/look_at.hpp"
#include "scene/photo_shifts.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;

bool is_rotation(const glm::dmat3& r) {
    const glm::dmat3 square = r * glm::transpose(r);
    double error = std::abs(glm::determinant(r) - 1);
    for (int c = 0; c < 3; ++c) error = std::max(error, glm::length(square[c] - glm::dmat3(1)[c]));
    return error < 1e-9;
}

given_pose some_pose(int i = 0) {
    const glm::dvec3 eye{3 * std::cos(i), 3 * std::sin(i), 1 + 0.3 * std::cos(5.0 * i)};
    return {gs::look_at(eye, {0, 0, 0}, {0, 0, 1}, 64, 70), 3.2};
}

std::size_t at(std::size_t view, unsigned k) { return view * pose_width + k; }

/// Trains with this state of the feature, and returns the engine.
std::unique_ptr<gs::train::engine> trained(make_engine make, const gs::scene& scene,
                                           const selected_feature& poses,
                                           gs::accumulator sums = gs::accumulator::native,
                                           int iterations = 60) {
    auto e = make();
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    o.max_cap = 3000;
    o.gradient = sums;
    o.features = feature_set({poses});
    e->set_views(scene.train, scene.test, o.schedule.num_downscales);
    e->set_model(gs::from_points(scene.points, 0, 2000, 1));
    gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
    return e;
}

/// Trains from the given poses, or without the feature.
std::unique_ptr<gs::train::engine> trained(make_engine make, const gs::scene& scene, bool learns,
                                           gs::accumulator sums = gs::accumulator::native,
                                           int iterations = 60) {
    return trained(make, scene, {"poses", learns, "", poses_feature().neutral_values(scene)}, sums,
                   iterations);
}

void check_not_shifted(const std::string& world) {
    CAPTURE(world);
    const gs::scene scene = small_scene(("synthetic:" + world).c_str(), 128);
    const gs::photo_shifts found = gs::measure_shifts(scene, 60);
    CHECK(found.judged() >= gs::photo_shifts::least_photos);
    CHECK(found.median_shift() < 0.8);
}

}  // namespace

TEST_CASE("poses: a turned camera shifts its photo against the points, by the angle of the turn") {
    gs::scene scene = small_scene("synthetic:spheres,views=12", 128);
    constexpr double degrees = 1.5;
    gs::camera& turned = scene.train[4].camera;
    const glm::dmat3 turn(
        glm::mat3_cast(glm::angleAxis(degrees * std::numbers::pi / 180, glm::dvec3(0, 1, 0))));
    turned.rotation = turn * turned.rotation;
    turned.translation = turn * turned.translation;
    const gs::photo_shifts found = gs::measure_shifts(scene, 60);
    CHECK(found.judged() >= 10);
    CHECK(!found.are_clear());  // a single photo does not call for the effect
    CHECK(found.median_shift() < 0.7);
    REQUIRE(found.photos[4].is_judged);
    const double expected = turned.fx * std::tan(degrees * std::numbers::pi / 180);
    // The points moved to the right in the image, so their colors lie to the left.
    CHECK(found.photos[4].pixels.x == doctest::Approx(-expected).epsilon(0.25));
    CHECK(std::abs(found.photos[4].pixels.y) < 0.7);
}

TEST_CASE("poses: photos do not seem shifted for other reasons") {
    for (const char* world : {"spheres,noise=0.05", "spheres,exposure=0.5,vignetting=0.5", "spheres,scales=6",
                              "spheres,moving=0.5"})
        check_not_shifted(world);
}

TEST_CASE("long: poses: photos do not seem shifted for many other reasons") {
    for (const char* world :
         {"spheres", "spheres,gloss=1", "spheres,sky=0.8", "spheres,walls=0.8", "spheres,passers=0.2",
          "spheres,blur=8", "spheres,shutter=8", "spheres,fisheye=60"})
        check_not_shifted(world);
}

TEST_CASE("poses: a few points of random colors do not seem shifted") {
    gs::scene scene = small_scene("synthetic:spheres,views=24,points=300", 128);
    gs::train::counter_random random(5, 0, 0);
    for (gs::colored_point& p : scene.points)
        p.color = glm::u8vec3(static_cast<std::uint8_t>(random.below(256)));
    const gs::photo_shifts found = gs::measure_shifts(scene, 60);
    CHECK(found.examined == scene.train.size());
    CHECK(!found.are_clear());
}

TEST_CASE("poses: photos that do not show the colors of points are not judged") {
    gs::scene scene = small_scene("synthetic:spheres,views=8", 128);
    for (gs::colored_point& p : scene.points) p.color = {128, 128, 128};
    CHECK(gs::measure_shifts(scene, 60).judged() == 0);
    CHECK(!poses_feature().analyze(gs::scene_statistics(scene)).recommended);
    scene.points.clear();
    CHECK(gs::measure_shifts(scene, 60).judged() == 0);
}

TEST_CASE("poses: any finite change gives a valid pose, at singular angles, too") {
    for (const double angle :
         {0.0, 1e-30, 1e-9, 1e-4, 9.99e-4, 1.001e-3, 0.5, std::numbers::pi, 2 * std::numbers::pi, 1e6})
        for (const float shift : {0.0f, 1e-20f, 3.0f, 1e15f}) {
            CAPTURE(angle);
            CAPTURE(shift);
            pose_change change{0, static_cast<float>(angle), 0, 0, 0, shift};
            const gs::camera c = moved(some_pose(), change);
            CHECK(is_rotation(c.rotation));
            CHECK(std::isfinite(glm::length(c.translation)));
        }
    const given_pose given = some_pose();
    const gs::camera same = moved(given, {});
    CHECK(same.rotation == given.camera.rotation);
    CHECK(glm::length(same.translation - given.camera.translation) < 1e-15);
}

TEST_CASE("poses: a turn keeps the center, and a shift keeps a point at the typical depth in its place") {
    const given_pose given = some_pose();
    const gs::camera turned = moved(given, {0.2f, 0.1f, -0.3f, 0, 0, 0});
    CHECK(glm::length(turned.center() - given.camera.center()) < 1e-12);
    const glm::dvec3 pivot =
        given.camera.center() + given.depth * glm::transpose(given.camera.rotation) * glm::dvec3(0, 0, 1);
    const gs::camera shifted = moved(given, {0, 0, 0, 0.02f, -0.03f, 0});
    CHECK(glm::length(shifted.center() - given.camera.center()) ==
          doctest::Approx(shift_unit * std::hypot(0.02, 0.03)).epsilon(1e-6));
    const auto before = given.camera.see(pivot), after = shifted.see(pivot);
    CHECK(after->x == doctest::Approx(before->x).epsilon(1e-4));
    CHECK(after->y == doctest::Approx(before->y).epsilon(1e-4));
}

TEST_CASE("poses: a motion of the whole scene and a change in camera space are removed, and the rest stays") {
    std::vector<given_pose> given;
    for (int i = 0; i < 12; ++i) given.push_back(some_pose(i));
    std::vector<float> changes(given.size() * pose_width);
    // The scene turns by a small angle and moves.
    const glm::dvec3 turn{1e-3, -2e-3, 3e-3}, move{0.004, -0.003, 0.002};
    for (std::size_t v = 0; v < given.size(); ++v) {
        const gs::camera& c = given[v].camera;
        const glm::dvec3 shift = c.rotation * (glm::cross(turn, c.center()) + move) / shift_unit;
        const double angle = shift_unit / given[v].depth;
        const glm::dvec3 whole = -(c.rotation * turn);
        const glm::dvec3 own = whole - glm::dvec3(-angle * shift.y, angle * shift.x, 0);
        for (unsigned k = 0; k < 3; ++k) {
            changes[at(v, k)] = static_cast<float>(own[static_cast<int>(k)]) + 0.01f;  // and all cameras turn
            changes[at(v, 3 + k)] = static_cast<float>(shift[static_cast<int>(k)]);
        }
    }
    std::vector<float> disturbed = changes;
    remove_common_motion(given, changes);
    for (const float x : changes) CHECK(std::abs(x) < 2e-5f);

    disturbed[at(4, 1)] += 0.02f;
    remove_common_motion(given, disturbed);
    CHECK(disturbed[at(4, 1)] > 0.01f);
    for (std::size_t v = 0; v < given.size(); ++v)
        if (v != 4) CHECK(std::abs(disturbed[at(v, 1)]) < 0.01f);

    std::vector<float> of_one(pose_width, 0.5f);  // fewer values than unknowns
    remove_common_motion({some_pose()}, of_one);
    for (const float x : of_one) CHECK(std::abs(x) < 1e-3f);
}

TEST_CASE("poses: the cameras of a rig move like one body") {
    gs::scene scene;
    for (int i = 0; i < 4; ++i) {
        gs::view v;
        v.camera = some_pose(i).camera;
        if (i != 1) v.rig_frame = i == 3 ? 5 : 7;  // views 0 and 2 are of one rig
        scene.train.push_back(v);
    }
    const std::vector<given_pose> given = given_poses(scene);
    CHECK(given[2].leader == std::size_t{0});
    for (const std::size_t v : {0, 1, 3}) CHECK(!given[v].leader);
    for (const given_pose& g : given) {
        const auto numbers = numbers_of(g);
        const given_pose same = from_numbers(g.camera, numbers);
        CHECK(same.leader == g.leader);
        CHECK(numbers_of(same) == numbers);
        CHECK(moved(g, {}).rotation == g.camera.rotation);
        CHECK(glm::length(moved(g, {}).translation - g.camera.translation) < 1e-15);
    }

    const pose_change change{0.2f, -0.4f, 0.3f, 0.5f, -0.1f, 0.7f};
    const gs::camera &leader = given[0].camera, &other = given[2].camera;
    const gs::camera leader_moved = moved(given[0], change), other_moved = moved(given[2], change);
    CHECK(is_rotation(other_moved.rotation));
    const glm::dmat3 before = other.rotation * glm::transpose(leader.rotation),
                     after = other_moved.rotation * glm::transpose(leader_moved.rotation);
    for (int c = 0; c < 3; ++c) CHECK(glm::length(before[c] - after[c]) < 1e-12);
    CHECK(glm::length(leader.rotation * (other.center() - leader.center()) -
                      leader_moved.rotation * (other_moved.center() - leader_moved.center())) < 1e-12);
    CHECK(glm::length(other_moved.center() - other.center()) > 0.1);

    // The common motion is that of leaders only, and followers have no change of their own.
    std::vector<float> changes(given.size() * pose_width, 0.0f);
    changes[at(0, 1)] = 0.1f;
    remove_common_motion(given, changes);
    for (unsigned k = 0; k < pose_width; ++k) CHECK(changes[at(2, k)] == 0);
}

TEST_CASE("poses: changes that move cameras to given places are found, also for rigs") {
    gs::scene scene;
    for (int i = 0; i < 5; ++i) {
        gs::view v;
        v.camera = some_pose(i).camera;
        if (i < 3) v.rig_frame = 7;
        scene.train.push_back(v);
    }
    const std::vector<given_pose> given = given_poses(scene);
    const pose_change of_rig{0.02f, -0.04f, 0.03f, 0.05f, -0.01f, 0.07f}, other{0, 0.1f, 0, 0.2f, 0, 0};
    std::vector<std::optional<gs::camera>> cameras{
        std::nullopt, moved(given[1], of_rig), moved(given[2], of_rig), moved(given[3], other), std::nullopt};
    auto found = changes_to(cameras, given);
    REQUIRE(found.size() == 5);
    REQUIRE(found[0]);
    REQUIRE(found[3]);
    for (unsigned k = 0; k < pose_width; ++k) {
        CHECK((*found[0])[k] == doctest::Approx(of_rig[k]).epsilon(1e-4));
        CHECK((*found[3])[k] == doctest::Approx(other[k]).epsilon(1e-4));
    }
    for (const std::size_t v : {1, 2, 4}) CHECK(!found[v]);
    cameras[0] = given[0].camera;  // the cameras of a rig do not agree
    found = changes_to(cameras, given);
    CHECK((*found[0])[1] == doctest::Approx(of_rig[1] * 2 / 3).epsilon(0.01));
}

TEST_CASE("poses: training begins with corrected poses, from which steps are small") {
    const gs::scene truth = small_scene("synthetic:spheres", 128);
    gs::scene scene = small_scene("synthetic:spheres,poses=1", 128);
    gs::image& hidden = scene.train[9].pixels;
    hidden.has_mask = true;
    for (std::size_t i = 0; i < hidden.rgba.size() / 4; ++i) hidden.mask_pixel(i);
    const finding found = poses_feature().analyze(gs::scene_statistics(scene));
    REQUIRE(found.recommended == true);
    CHECK(found.choice == "on, beginning with the corrected poses of 39 of 40 photos");
    const std::vector<pose_start> starts = starts_in(found.values);
    REQUIRE(starts.size() == scene.train.size());
    CHECK(starts[9].change == pose_change{});
    CHECK(starts[9].largest_step > starts[8].largest_step);

    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, scene.test, 0);
    engine->set_model(gs::from_points(scene.points, 0, 100, 1));
    gs::train::training_setup setup;
    setup.facts.views = static_cast<int>(scene.train.size());
    setup.features["poses"] = found.values;
    engine->begin(setup);
    const glm::dvec3 at(0.2, -0.3, 0.4);
    double before = 0, after = 0;
    for (std::size_t v = 0; v < scene.train.size(); ++v) {
        if (v == 9) continue;
        const gs::camera& given = scene.train[v].camera;
        const auto expected = truth.train[v].camera.see(at), shown = given.see(at),
                   corrected = engine->cameras().training_camera(v, given).see(at);
        before += std::hypot(shown->x - expected->x, shown->y - expected->y);
        after += std::hypot(corrected->x - expected->x, corrected->y - expected->y);
    }
    CAPTURE(before);
    CAPTURE(after);
    CHECK(after < 0.15 * before);
    CHECK(engine->cameras().training_camera(9, scene.train[9].camera).rotation ==
          scene.train[9].camera.rotation);
}

TEST_CASE("poses: without clear shifts or without points, training begins with the given poses") {
    gs::scene scene = small_scene("synthetic:spheres", 128);
    const finding exact = poses_feature().analyze(gs::scene_statistics(scene));
    CHECK(exact.recommended == false);
    for (const pose_start& start : starts_in(exact.values)) {
        CHECK(start.change == pose_change{});
        CHECK(start.largest_step > 0);
        CHECK(start.largest_step < 0.5f * step_from_given);
    }
    scene.points.clear();
    const finding unknown = poses_feature().analyze(gs::scene_statistics(scene));
    CHECK(!unknown.recommended);
    CHECK(unknown.values == poses_feature().neutral_values(scene));
    for (const pose_start& start : starts_in(unknown.values)) CHECK(start.largest_step == step_from_given);
}

TEST_CASE("poses: only drift since the start is removed, and not what first changes have in common") {
    const gs::scene scene = small_scene("synthetic:spheres,views=8", 32);
    std::vector<pose_start> starts(scene.train.size());
    for (std::size_t v = 0; v < starts.size(); ++v) {
        const glm::vec3 shift(scene.train[v].camera.rotation * glm::dvec3(0.1, -0.1, 0.2));
        starts[v] = {{0, 0, 0, shift.x, shift.y, shift.z}, 1e-4f};
    }
    const selected_feature poses{"poses", true, "", initial_values(given_poses(scene), starts)};
    const auto engine = trained(gs::train::make_cpu_engine, scene, poses);
    const std::vector<float> values = engine->feature("poses").values();
    bool are_same = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float first = starts[i / pose_width].change[i % pose_width];
        CHECK(std::abs(values[i] - first) < 0.01f);  // 8 steps, and drift
        are_same = are_same && values[i] == first;
    }
    CHECK(!are_same);
}

TEST_CASE("poses: initial values for another number of photos are an error") {
    const gs::scene scene = small_scene("synthetic:spheres,views=8", 32);
    std::vector<float> values = poses_feature().neutral_values(scene);
    values.resize(values.size() - start_width);
    for (const auto make : engines()) {
        const auto engine = make();
        engine->set_views(scene.train, {}, 0);
        engine->set_model(gs::from_points(scene.points, 0, 100, 1));
        gs::train::training_setup setup;
        setup.facts.views = static_cast<int>(scene.train.size());
        setup.features["poses"] = values;
        CHECK_THROWS_WITH_AS(engine->begin(setup), doctest::Contains("training photos need"), gs::error);
    }
}

TEST_CASE("poses: training moves the cameras of a rig like one body") {
    gs::scene scene = small_scene("synthetic:spheres,poses=1", 32);
    for (std::size_t v = 0; v < scene.train.size(); ++v)
        scene.train[v].rig_frame = static_cast<std::uint32_t>(v / 2);
    for (const auto make : engines()) {
        const auto e = trained(make, scene, true);
        const auto learned = [&](std::size_t v) {
            return e->cameras().training_camera(v, scene.train[v].camera);
        };
        for (std::size_t v = 0; v + 1 < scene.train.size(); v += 2) {
            const gs::camera &a = scene.train[v].camera, &b = scene.train[v + 1].camera;
            const gs::camera c = learned(v), d = learned(v + 1);
            CHECK(glm::length(a.rotation * (b.center() - a.center()) -
                              c.rotation * (d.center() - c.center())) < 1e-5);
            CHECK(glm::length(c.center() - a.center()) > 0);
            CHECK(c.rotation != a.rotation);
        }
    }
}

TEST_CASE("long: poses: training and refinement correct poses that are wrong") {
    const gs::scene scene = small_scene("synthetic:spheres,poses=2,views=24", 48);
    for (const auto make : engines()) {
        constexpr std::size_t views = 2;
        const auto psnr_of = [&](gs::train::engine& e, bool refines) {
            double sum = 0;
            for (std::size_t v = 0; v < views; ++v) {
                const auto render =
                    e.render(refines ? e.cameras().refined_camera(v, {}) : scene.test[v].camera, {});
                const auto photo = over_background(scene.test[v].pixels, std::array<float, 3>{}.data());
                double square = 0;
                for (std::size_t i = 0; i < render.size(); ++i)
                    square += std::pow(static_cast<double>(render[i] - photo[i]), 2);
                sum += -10 * std::log10(square / static_cast<double>(render.size()));
            }
            return sum / static_cast<double>(views);
        };
        const auto without = trained(make, scene, false, gs::accumulator::native, 400),
                   with = trained(make, scene, true, gs::accumulator::native, 400);
        CHECK(without->cameras().refined_camera(0, {}).rotation == scene.test[0].camera.rotation);
        without->feature("poses").set_values(poses_feature().neutral_values(scene));
        const double given = psnr_of(*without, false), refined = psnr_of(*without, true),
                     learned = psnr_of(*with, true);
        CAPTURE(given);
        CAPTURE(refined);
        CAPTURE(learned);
        CHECK(refined > given + 3);
        CHECK(learned > refined + 0.6);
    }
}

TEST_CASE("poses: fixed-point sums give the same poses and cameras each time") {
    const gs::scene scene = small_scene("synthetic:spheres,poses=1", 32);
    for (const auto make : engines()) {
        const auto first = trained(make, scene, true, gs::accumulator::fixed);
        const auto second = trained(make, scene, true, gs::accumulator::fixed);
        const auto values = first->feature("poses").values();
        CHECK(values == second->feature("poses").values());
        CHECK(std::ranges::any_of(values, [](float x) { return std::abs(x) > 1e-3f; }));
        CHECK(first->get_model().mean == second->get_model().mean);
        CHECK(first->cameras().training_camera(3, scene.train[3].camera).rotation !=
              scene.train[3].camera.rotation);
    }
}

TEST_CASE("poses: without the feature, cameras keep their poses") {
    const gs::scene scene = small_scene("synthetic:spheres", 32);
    const auto e = gs::train::make_cpu_engine();
    e->set_views(scene.train, {}, 0);
    CHECK(e->cameras().training_camera(2, scene.train[2].camera).rotation == scene.train[2].camera.rotation);
    CHECK(e->cameras().training_camera(2, scene.train[2].camera).translation ==
          scene.train[2].camera.translation);
}

TEST_CASE("poses: the results are poses in world coordinates, and a run without the effect removes them") {
    gs::scene scene = small_scene("synthetic:spheres,poses=1", 32);
    scene.normalization = {{10, 20, 30}, 2};
    const auto e = trained(gs::train::make_cpu_engine, scene, true);
    const auto folder = std::filesystem::temp_directory_path() / "warpagg_test_poses";
    std::filesystem::create_directories(folder);
    const selected_feature on{"poses", true, "", {}}, off{"poses", false, "", {}};
    poses_feature().write_results(on, *e, scene, folder);
    const auto json = nlohmann::json::parse(std::ifstream(folder / "poses.json"));
    CHECK(json.size() == scene.train.size());
    const auto& pose = json.at(scene.train[5].name);
    const gs::camera learned = e->cameras().training_camera(5, scene.train[5].camera);
    const glm::dvec3 center = scene.normalization.to_world(learned.center());
    for (std::size_t row = 0; row < 3; ++row) {
        const int r = static_cast<int>(row);
        CHECK(pose.at("camera_to_world")[row][3].get<double>() == doctest::Approx(center[r]));
        CHECK(pose.at("camera_to_world")[row][2].get<double>() == doctest::Approx(learned.rotation[r][2]));
    }
    const double turned = pose.at("turned_by_degrees");
    CHECK(turned > 0.01);
    CHECK(turned < 3);
    const double moved_by = glm::length(learned.center() - scene.train[5].camera.center());
    CHECK(pose.at("moved_by").get<double>() == doctest::Approx(2 * moved_by));
    poses_feature().write_results(off, *e, scene, folder);
    CHECK_FALSE(std::filesystem::exists(folder / "poses.json"));
    std::filesystem::remove_all(folder);
}
