// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engines.hpp"
#include "options/option_value.hpp"
#include "photos/packed_photo.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

struct outcome {
    gs::device::memory_forecast forecast;
    std::size_t used = 0;  ///< largest size of all buffers
    std::size_t gaussians = 0;
    std::vector<std::string> warnings;
    gs::train::train_result result;
};

/// Trains with a strategy that grows from 4000 Gaussians to `most`, if memory permits it.
outcome grown(make_engine make, const gs::scene& scene, const std::string& strategy, std::size_t most,
              std::uint64_t max_bytes, std::uint64_t host_bytes = 0) {
    outcome found;
    gs::train::train_options o;
    o.schedule.iterations = 240;
    o.schedule.num_downscales = 0;
    o.densification.name = strategy;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 10;
    adaptive.densification_interval = 20;
    adaptive.densify_until_iter = 200;
    adaptive.densify_grad_threshold = 1e-9;
    o.max_cap = most;
    o.max_device_bytes = max_bytes;
    o.host_bytes = host_bytes;
    const auto engine = make();
    const std::size_t before = engine->profile().used_device_bytes();
    engine->set_views(scene.train, {}, 0);
    engine->set_model(gs::from_points(scene.points, 3, 4000, 1));
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    events.warn = [&](const std::string& line) { found.warnings.push_back(line); };
    events.begins = [&] { found.forecast = engine->profile().forecast(most, 3); };
    events.is_interrupted = [&] {
        found.used = std::max(found.used, engine->profile().used_device_bytes() - before);
        return false;
    };
    found.result = gs::train::train(*engine, scene, o, events);
    found.gaussians = engine->count();
    return found;
}

gs::scene scene_with_points() { return small_scene("synthetic:spheres,points=8000", 32); }

}  // namespace

TEST_CASE("memory: the forecast before training is near the memory that training needs") {
    const gs::scene scene = scene_with_points();
    std::uint64_t photos = 0;
    for (const gs::view& v : scene.train) photos += gs::photos::packed_bytes(v.camera, v.depths.is_there());
    for (const auto make : engines()) {
        const outcome run = grown(make, scene, "mcmc", 15000, 0);
        REQUIRE(run.gaussians == 15000);
        CHECK(run.forecast.photos == photos);
        CHECK(run.result.growth_limited_by == "max_cap");
        const double relative = static_cast<double>(run.forecast.total()) / static_cast<double>(run.used);
        CAPTURE(run.forecast.gaussians);
        CAPTURE(run.forecast.others);
        CAPTURE(run.used);
        CHECK(relative > 0.8);
        CHECK(relative < 1.25);
    }
}

TEST_CASE("long: memory: growth stops near the limit, with one warning") {
    const gs::scene scene = scene_with_points();
    for (const auto make : engines())
        for (const std::string strategy : {"adaptive", "mcmc"}) {
            CAPTURE(strategy);
            const outcome free = grown(make, scene, strategy, 15000, 0);
            CHECK(free.warnings.empty());
            REQUIRE(free.gaussians > 7000);
            const std::uint64_t limit = free.used / 2;
            const outcome limited = grown(make, scene, strategy, 15000, limit);
            CHECK(limited.gaussians > 4000);
            CHECK(limited.gaussians < 3 * free.gaussians / 4);
            CHECK(static_cast<double>(limited.used) < 1.1 * static_cast<double>(limit));
            CHECK(limited.result.growth_limited_by == "gpu_memory");
            REQUIRE(limited.warnings.size() == 1);
            CHECK(limited.warnings[0].find("--gpu-memory") != std::string::npos);
        }
}

TEST_CASE("long: memory: a model that reaches the limit grows on when SH coefficients move to the host") {
    const gs::scene scene = scene_with_points();
    for (const auto make : engines()) {
        const bool gains_room = !make()->profile().shares_host_memory();
        const std::uint64_t limit = grown(make, scene, "mcmc", 15000, 0).used / 2;
        const outcome alone = grown(make, scene, "mcmc", 15000, limit);
        const outcome helped = grown(make, scene, "mcmc", 15000, limit, std::uint64_t{1} << 30);
        REQUIRE(helped.warnings.size() >= 2);
        CHECK(helped.warnings[0].find("SH coefficients from degree 3 on lie in host memory") !=
              std::string::npos);
        CHECK(helped.warnings[1].find("from degree 2 on") != std::string::npos);
        if (gains_room) CHECK(helped.gaussians > alone.gaussians);
        CHECK(static_cast<double>(helped.used) < 1.1 * static_cast<double>(limit));
    }
}

TEST_CASE("sizes in bytes have decimal and binary units") {
    using gs::options::read_byte_size;
    CHECK(read_byte_size("16GiB") == std::uint64_t{16} << 30);
    CHECK(read_byte_size("500MB") == 500'000'000);
    CHECK(read_byte_size("1.5kB") == 1500);
    CHECK(read_byte_size("7") == 7);
    for (const char* word : {"", "GiB", "-1GB", "1 GB", "1gb", "1XB", "0", "0GB", "1e3", "nan", "1.2.3MB",
                             "9999999999TB", "0x10"}) {
        CAPTURE(word);
        CHECK_THROWS_AS(read_byte_size(word), gs::options::refused_word);
    }
}
