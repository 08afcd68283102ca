// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "check_equal.hpp"
#include "engines.hpp"
#include "features/depth/depth_feature.hpp"
#include "features/exposure/exposure_feature.hpp"
#include "photos/packed_photo.hpp"
#include "photos/photo_plan.hpp"
#include "photos/photo_stream.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"
#include "training/view_order.hpp"

namespace {

using gs::photos::photo_limits;
using gs_test::error_of;
using gs_test::says;

/// Masked, transparent photos with depth maps.
constexpr const char* all_kinds = "synthetic:alpha,depths=0.02,passers=0.1";

/// The same scene with photos that are decoded on request. `before_decoding` is called each time.
gs::scene streamed(const gs::scene& of, const std::function<void(const std::string&)>& before_decoding = {}) {
    gs::scene result = of;
    for (auto* views : {&result.train, &result.test})
        for (gs::view& v : *views) {
            const auto held = std::make_shared<const gs::photo>(gs::photo{v.pixels, v.depths});
            v.pixels.rgba.clear();
            v.depths.values.clear();
            v.decode_bytes = held->pixels.rgba.size();
            v.decode = [held, before_decoding, name = v.name](gs::photo& into) {
                if (before_decoding) before_decoding(name);
                into = *held;
            };
        }
    return result;
}

/// A scene whose photos are JPEG files, once with photos in memory and once with photos that are read on
/// request.
struct scene_of_jpegs {
    gs_test::temporary_folder folder;
    gs::scene resident, streamed;
    std::atomic<int> decoded = 0;      ///< calls of `view::decode`
    std::atomic<int> planes_read = 0;  ///< calls of `view::read_planes`

    explicit scene_of_jpegs(gs::scene of) : resident(std::move(of)) {
        for (gs::view& v : resident.train) {
            const auto file = folder.path() / (v.name + ".jpg");
            std::filesystem::create_directories(file.parent_path());
            std::vector<std::uint8_t> rgb;
            for (std::size_t i = 0; i < v.pixels.rgba.size(); ++i)
                if (i % 4 < 3) rgb.push_back(v.pixels.rgba[i]);
            const auto bytes = gs::encode_jpeg(v.camera.width, v.camera.height, rgb, 90);
            std::ofstream(file, std::ios::binary)
                .write(reinterpret_cast<const char*>(bytes.data()),
                       static_cast<std::streamsize>(bytes.size()));
            v.pixels = gs::read_image(file);
        }
        resident.test.clear();
        streamed = resident;
        for (gs::view& v : streamed.train) {
            const auto file = folder.path() / (v.name + ".jpg");
            v.pixels.rgba.clear();
            v.decode_bytes = 4 * static_cast<std::size_t>(v.camera.width * v.camera.height);
            v.decode = [this, file](gs::photo& into) {
                ++decoded;
                gs::read_image(file, into.pixels);
            };
            v.plane_bytes = gs::jpeg_plane_bytes(file);
            v.read_planes = [this, file](gs::jpeg_planes& into) {
                ++planes_read;
                gs::read_jpeg_planes(file, into);
            };
        }
    }
};

std::uint64_t bytes_of(const std::vector<gs::view>& views) {
    std::uint64_t bytes = 0;
    for (const gs::view& v : views) bytes += gs::photos::packed_bytes(v.camera, v.depths.is_there());
    return bytes;
}

/// A short deterministic run in which the size level, the number of Gaussians and the SH degree
/// change, and that loses SH coefficients, for which it renders all views.
gs::train::train_options short_run(const gs::scene& scene) {
    gs::train::train_options o;
    o.schedule.iterations = 60;
    o.schedule.num_downscales = 2;
    o.schedule.sh_degree_interval = 10;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 10;
    adaptive.densification_interval = 15;
    adaptive.densify_until_iter = 50;
    adaptive.densify_grad_threshold = 1e-5;
    o.max_cap = 1000;
    o.gradient = gs::accumulator::fixed;
    o.background.random = true;
    o.features = gs::features::feature_set(
        {{"direction", true, "", {1, 1}},
         {"exposure", true, "", gs::features::exposure_feature().neutral_values(scene)},
         {"depth", true, "", gs::features::depth_feature().neutral_values(scene)}});
    return o;
}

struct streamed_outcome {
    gs::gaussians model;
    std::vector<double> held_out;
    std::map<int, gs::state_archive> checkpoints;
};

/// Trains with at most four threads that decode.
streamed_outcome trained(make_engine make, const gs::scene& scene, const gs::train::train_options& o,
                         const photo_limits& limits) {
    const auto engine = make();
    gs::photos::photo_plan plan;
    if (gs::photos::any_is_streamed(scene.train, scene.test))
        plan = gs::photos::plan_photos(scene.train, scene.test, limits, 4);
    engine->set_views(scene.train, scene.test, o.schedule.num_downscales, plan);
    engine->set_model(gs::from_points(scene.points, 1, 300, 1));
    streamed_outcome result;
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    events.checkpoint = [&](int iteration, gs::state_archive& archive) {
        result.checkpoints.insert_or_assign(iteration, gs::state_archive(archive.values(), archive.arrays()));
    };
    gs::train::train(*engine, scene, o, events);
    result.model = engine->get_model();
    for (std::size_t v = 0; v < scene.test.size(); ++v)
        result.held_out.push_back(engine->measure(v, {}).square_error);
    return result;
}

/// The smallest limit with which the scene trains.
std::uint64_t least_total(const gs::scene& scene) {
    const auto plan = gs::photos::plan_photos(scene.train, scene.test, {}, 1);
    return plan.on_host() + plan.on_device() - plan.host_bytes - plan.device_bytes;
}

}  // namespace

TEST_CASE("streamed photos: training gives the same model as resident photos bit for bit") {
    const gs::scene resident = small_scene(all_kinds, 24);
    REQUIRE(std::ranges::any_of(resident.train, [](const gs::view& v) { return v.pixels.has_mask; }));
    REQUIRE(resident.has_alpha);
    REQUIRE(resident.train[0].depths.is_there());
    const gs::scene scene = streamed(resident);
    const std::uint64_t least = least_total(scene), all = bytes_of(scene.train) + bytes_of(scene.test);
    REQUIRE(least < all / 2);
    const gs::train::train_options o = short_run(resident);
    for (const auto make : engines()) {
        const streamed_outcome expected = trained(make, resident, o, {});
        CHECK(expected.model.count() > 350);
        for (const photo_limits& limits :
             {photo_limits{.total = least}, photo_limits{.total = least + all / 3},
              photo_limits{.total = 4 * least + 2 * all},
              photo_limits{.total = 4 * least + 2 * all, .device = least / 2}}) {
            CAPTURE(limits.total);
            const streamed_outcome found = trained(make, scene, o, limits);
            check_equal(found.model, expected.model);
            CHECK(found.held_out == expected.held_out);
        }
    }
}

TEST_CASE("streamed photos: photos within the limits are decoded once per size, others once per use") {
    const gs::scene resident = small_scene("synthetic:spheres", 24);
    std::atomic<int> decoded = 0;
    const gs::scene scene = streamed(resident, [&](const std::string&) { ++decoded; });
    gs::train::train_options o;
    o.schedule.iterations = 3 * static_cast<int>(scene.train.size());
    o.schedule.num_downscales = 0;
    const std::uint64_t least = least_total(scene), all = bytes_of(scene.train) + bytes_of(scene.test);
    const auto decoded_with = [&](const photo_limits& limits) {
        decoded = 0;
        const auto engine = gs::train::make_cpu_engine();
        engine->set_views(scene.train, {}, 0, gs::photos::plan_photos(scene.train, {}, limits, 1));
        engine->set_model(gs::from_points(scene.points, 0, 50, 1));
        gs::train::train(*engine, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
        return decoded.load();
    };
    const int views = static_cast<int>(scene.train.size());
    CHECK(decoded_with({.total = least + all}) == views);
    // Photos that stay in host memory are not decoded again either.
    CHECK(decoded_with({.total = 2 * least + 2 * all, .device = least / 2}) == views);
    CHECK(decoded_with({.total = least}) >= 3 * views);
}

TEST_CASE("streamed photos: JPEGs stay on the host as samples, of which more fit into the limit") {
    scene_of_jpegs scene(small_scene("synthetic:spheres", 48));
    const std::uint64_t least = least_total(scene.streamed), all = bytes_of(scene.streamed.train);
    std::uint64_t kept = 0;
    for (const gs::view& v : scene.streamed.train) kept += gs::photos::kept_bytes(v);
    REQUIRE(kept < all / 2);
    const photo_limits limits{.total = 4 * least + kept};
    const auto plan = gs::photos::plan_photos(scene.streamed.train, {}, limits, 1);
    CHECK(plan.on_host() + plan.on_device() <= limits.total);
    CHECK(plan.host_bytes + plan.device_bytes < all);
    gs::train::train_options o;
    o.schedule.iterations = 3 * static_cast<int>(scene.streamed.train.size());
    o.schedule.num_downscales = 0;
    o.gradient = gs::accumulator::fixed;
    for (const auto make : engines()) {
        const streamed_outcome expected = trained(make, scene.resident, o, {});
        scene.decoded = scene.planes_read = 0;
        check_equal(trained(make, scene.streamed, o, limits).model, expected.model);
        CHECK(scene.decoded + scene.planes_read == static_cast<int>(scene.streamed.train.size()));
        CHECK(scene.planes_read > static_cast<int>(scene.streamed.train.size()) / 2);
    }
}

TEST_CASE("photo_stream: one decoding makes all sizes of a photo that stay in host memory") {
    const gs::scene resident = small_scene("synthetic:spheres", 24);
    std::atomic<int> decoded = 0;
    const gs::scene scene = streamed(resident, [&](const std::string&) { ++decoded; });
    const std::size_t views = scene.train.size();
    std::vector<std::uint8_t> bytes(gs::photos::packed_bytes(scene.train[0].camera, false));
    gs::photos::photo_stream stream(scene.train, 1, {bytes.data()});
    const auto decodings = [&](std::size_t level) {
        const int before = decoded;
        for (std::size_t v = 0; v < views; ++v) {
            stream.expect({{v, level}});
            stream.release(stream.take({v, level}));
        }
        return static_cast<std::size_t>(decoded - before);
    };
    std::vector<gs::photos::level_range> kept(views, {0, 3});
    kept[0] = {};
    kept[1] = {1, 2};
    stream.keep(kept);
    CHECK(decodings(2) == views);
    CHECK(decodings(1) == 1);
    CHECK(decodings(0) == 2);
    CHECK(bytes == resident.train.back().pixels.rgba);
    stream.keep(std::vector<gs::photos::level_range>(views, {0, 1}));
    CHECK(decodings(1) == views);
    CHECK(decodings(0) == 0);
    stream.keep(std::vector<gs::photos::level_range>(views));
    CHECK(decodings(0) == views);
}

TEST_CASE("streamed photos: photos that fit into memory are decoded once, although their size changes") {
    const gs::scene resident = small_scene("synthetic:spheres", 24);
    std::atomic<int> decoded = 0;
    const gs::scene scene = streamed(resident, [&](const std::string&) { ++decoded; });
    gs::train::train_options o;
    o.schedule.iterations = 6 * static_cast<int>(scene.train.size());
    o.schedule.num_downscales = 2;
    o.gradient = gs::accumulator::fixed;
    const std::uint64_t least = least_total(scene), all = bytes_of(scene.train) + bytes_of(scene.test);
    const photo_limits limits{.total = 4 * least + 3 * all, .device = least / 2};
    const gs::gaussians expected = trained(gs::train::make_cpu_engine, resident, o, {}).model;
    check_equal(trained(gs::train::make_cpu_engine, scene, o, limits).model, expected);
    // One photo stays in device memory, and is decoded once per size.
    CHECK(decoded.load() == static_cast<int>(scene.train.size() + scene.test.size()) + 2);
}

TEST_CASE("streamed photos: a run that continues from a checkpoint gives the same model bit for bit") {
    const gs::scene scene = streamed(small_scene(all_kinds, 24));
    const photo_limits limits{.total = least_total(scene) + bytes_of(scene.train) / 3};
    gs::train::train_options o = short_run(small_scene(all_kinds, 24));
    o.checkpoint_every = 1;
    for (const auto make : engines()) {
        streamed_outcome uninterrupted = trained(make, scene, o, limits);
        for (const int iteration : {9, 31}) {
            gs::train::train_options rest = o;
            rest.resume_from = &uninterrupted.checkpoints.at(iteration);
            check_equal(trained(make, scene, rest, limits).model, uninterrupted.model);
        }
    }
}

TEST_CASE("streamed photos: a lost photo ends training with a checkpoint and an error") {
    const gs::scene resident = small_scene("synthetic:spheres", 24);
    gs::train::train_options o;
    o.schedule.iterations = 60;
    o.gradient = gs::accumulator::fixed;
    const gs::gaussians uninterrupted =
        trained(gs::train::make_cpu_engine, streamed(resident), o, {.total = least_total(streamed(resident))})
            .model;

    std::atomic<int> decoded = 0;
    const gs::scene losing = streamed(resident, [&](const std::string& name) {
        if (++decoded > 20) throw gs::error(name + " is lost");
    });
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(losing.train, {}, 1,
                      gs::photos::plan_photos(losing.train, {}, {.total = least_total(losing)}, 1));
    engine->set_model(gs::from_points(losing.points, 1, 300, 1));
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    gs::state_archive saved;
    int saved_after = 0;
    events.checkpoint = [&](int iteration, gs::state_archive& archive) {
        saved = gs::state_archive(archive.values(), archive.arrays());
        saved_after = iteration;
    };
    CHECK(says(error_of([&] { gs::train::train(*engine, losing, o, events); }), {"is lost"}));
    CHECK(saved_after > 5);
    CHECK(saved_after < 21);
    o.resume_from = &saved;
    check_equal(trained(gs::train::make_cpu_engine, resident, o, {}).model, uninterrupted);
}

TEST_CASE("streamed photos: the plan keeps the limits, and an error names the smallest sufficient one") {
    const gs::scene scene = streamed(small_scene("synthetic:spheres", 48));
    const std::uint64_t least = least_total(scene), all = bytes_of(scene.train);
    for (const std::uint64_t total : {least, least + 1, 2 * least, 10 * least, 10 * least + all}) {
        CAPTURE(total);
        const auto plan = gs::photos::plan_photos(scene.train, {}, {.total = total, .device = least}, 8);
        CHECK(plan.on_host() + plan.on_device() <= total);
        CHECK(plan.on_device() <= least);
        CHECK(plan.workers >= 1);
        CHECK(plan.workers <= 8);
        // All memory is used, unless all photos stay in memory.
        CHECK((plan.on_host() + plan.on_device() == total || plan.host_bytes + plan.device_bytes >= all));
    }
    const std::string message =
        error_of([&] { gs::photos::plan_photos(scene.train, {}, {.total = least - 1}, 8); });
    CHECK(says(message, {"--photo-memory", "at least " + std::to_string((least + 999) / 1000) + "kB"}));
}

TEST_CASE("view_order: upcoming views are those that next returns, also across rounds") {
    gs::train::view_order order(5, 3);
    for (int i = 0; i < 7; ++i) order.next();
    for (const std::size_t expected : order.upcoming(13)) CHECK(order.next() == expected);
}
