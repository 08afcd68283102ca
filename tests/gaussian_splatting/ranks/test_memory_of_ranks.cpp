// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

#include "../cli/run_program.hpp"
#include "../training/engines.hpp"
#include "ranks/run.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

using namespace gs_test;
using gs::ranks::communicator;

namespace {

/// Bytes of one rank.
struct memory {
    double forecast = 0, used = 0;
};

/// Grows a model with SH coefficients of degree 3. Most of its memory is that of Gaussians.
memory train_in(communicator& all, const gs::scene& scene) {
    constexpr std::size_t most = 15000;
    memory found;
    gs::train::train_options o;
    o.schedule.iterations = 120;
    o.schedule.num_downscales = 0;
    o.densification.name = "mcmc";
    o.max_cap = most;
    o.ranks = &all;
    const auto engine = gs::train::make_cpu_engine();
    const std::size_t before = engine->profile().used_device_bytes();
    engine->ranks().join(all);
    engine->set_views(scene.train, {}, 0);
    engine->set_model(gs::from_points(scene.points, 3, 4000, 1));
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    events.is_interrupted = [&] {
        const auto used = static_cast<double>(engine->profile().used_device_bytes() - before);
        found.used = std::max(found.used, used);
        return false;
    };
    gs::train::train(*engine, scene, o, events);
    engine->ranks().prepare_renders();
    engine->render(scene.train[0].camera, {});
    events.is_interrupted();
    found.forecast = static_cast<double>(engine->profile().forecast(most, 3).total());
    return found;
}

/// Returns the memory of each rank.
std::vector<memory> memory_of(int ranks) {
    const temporary_folder folder;
    const auto end = gs::ranks::run(ranks, [&](communicator& all) {
        omp_set_num_threads(1);
        const memory found = train_in(all, small_scene("synthetic:spheres,points=8000", 64));
        std::ofstream(folder / std::to_string(all.rank())) << found.forecast << ' ' << found.used;
        return 0;
    });
    REQUIRE(end.reason == "");
    std::vector<memory> found(static_cast<std::size_t>(ranks));
    for (std::size_t r = 0; r < found.size(); ++r)
        std::ifstream(folder / std::to_string(r)) >> found[r].forecast >> found[r].used;
    return found;
}

/// Checks that each rank needs less than a part of the memory of one.
void check_memory_of(int ranks, double part) {
    const double alone = memory_of(1).front().used;
    for (const memory& found : memory_of(ranks)) {
        CAPTURE(ranks);
        CAPTURE(found.forecast);
        CAPTURE(found.used);
        CAPTURE(alone);
        CHECK(found.used < part * alone);
        CHECK(found.forecast > 0.75 * found.used);
        CHECK(found.forecast < 1.3 * found.used);
    }
}

}  // namespace

TEST_CASE("memory of ranks: each one has a part of the Gaussians, and the forecast knows it") {
    // Arrays of small models are gathered as one piece, so that ranks save less than with large models.
    check_memory_of(2, 0.85);
}

TEST_CASE("long: memory of ranks: more of them have smaller parts") { check_memory_of(4, 0.65); }
