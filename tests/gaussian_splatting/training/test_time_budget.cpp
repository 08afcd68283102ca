// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "check_equal.hpp"
#include "engines.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using gs::iteration_plan;
using gs::train::training_moment;

/// A machine with a clock. The time of a step depends on its image size and number of Gaussians.
struct machine {
    double fixed = 1e-3;          ///< seconds
    double by_pixels = 4e-3;      ///< seconds for images of full size
    double by_gaussians = 2e-8;   ///< seconds
    double noise = 0;             ///< largest relative deviation
    double slower_after = 1e300;  ///< seconds after which steps take twice the time
    double growth = 5;            ///< of the number of Gaussians, from 100,000
    double first_step = 0;        ///< additional seconds
};

struct budget_outcome {
    double seconds = 0;
    iteration_plan plan;
};

/// Runs a training loop without a model on `m`.
budget_outcome run_for(double seconds, const machine& m, int downscales = 1) {
    gs::train::schedule schedule;
    schedule.num_downscales = downscales;
    gs::train::time_budget budget(seconds, 10'000'000);
    std::mt19937 random(1);
    training_moment now{0, 0, 100'000};
    budget.begin(now, schedule);
    while (now.iteration < schedule.iterations.last()) {
        ++now.iteration;
        const double pixels = std::pow(0.25, schedule.downscales_at(now.iteration));
        const double uniform = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
        double step = m.fixed + m.by_pixels * pixels + m.by_gaussians * static_cast<double>(now.gaussians);
        step *= 1 + m.noise * (2 * uniform - 1);
        if (now.iteration == 1) step += m.first_step;
        now.seconds += now.seconds > m.slower_after ? 2 * step : step;
        const int until = schedule.iterations.milestone(0.5);
        if (now.iteration > 500 && now.iteration % 100 == 0 && now.iteration < until) {
            const double share = schedule.iterations.progress(now.iteration) / 0.5;
            now.gaussians = static_cast<std::size_t>(1e5 * (1 + (m.growth - 1) * share));
        }
        if (!budget.due(now.iteration)) continue;
        if (const auto last = budget.correction(now, schedule, until))
            schedule.iterations.correct(now.iteration, *last);
        budget.continue_from(now, schedule);
    }
    return {now.seconds, schedule.iterations};
}

}  // namespace

TEST_CASE("time budget: the run ends within 3 percent of its time") {
    std::map<std::string, machine> machines;
    machines["default"] = {};
    machines["small photos"] = {.by_pixels = 1e-4};
    machines["large photos"] = {.by_pixels = 4e-2};
    machines["many Gaussians"] = {.by_gaussians = 1e-6, .growth = 20};
    machines["no growth"] = {.growth = 1};
    machines["noise"] = {.noise = 0.3};
    machines["slow first step"] = {.first_step = 1};
    for (const auto& [name, machine] : machines)
        for (const double seconds : {5.0, 20.0, 60.0, 600.0, 7200.0})
            for (const int downscales : {0, 1, 2}) {
                CAPTURE(name);
                CAPTURE(seconds);
                CAPTURE(downscales);
                const budget_outcome o = run_for(seconds, machine, downscales);
                CAPTURE(o.plan.text());
                CHECK(std::abs(o.seconds - seconds) < 0.03 * seconds);
            }
}

TEST_CASE("time budget: the run ends in time on a machine that becomes slower half-way") {
    for (const double seconds : {20.0, 600.0})
        for (const double share : {0.1, 0.5, 0.9}) {
            CAPTURE(seconds);
            CAPTURE(share);
            const budget_outcome o = run_for(seconds, {.noise = 0.1, .slower_after = share * seconds});
            CHECK(std::abs(o.seconds - seconds) < 0.03 * seconds);
        }
    // The last correction precedes the change.
    const budget_outcome late = run_for(60, {.slower_after = 59.5});
    CHECK(late.seconds < 1.03 * 60);
}

TEST_CASE("time budget: a time shorter than a few steps ends after a few steps") {
    for (const double seconds : {1e-6, 1e-3, 0.02}) {
        CAPTURE(seconds);
        const budget_outcome o = run_for(seconds, {.first_step = 0.5});
        CHECK(o.plan.last() <= 3);
    }
    CHECK(run_for(0.4, {}).plan.last() < gs::train::time_budget::first_plan_after);
    CHECK(run_for(0.4, {}).seconds == doctest::Approx(0.4).epsilon(0.05));
}

TEST_CASE("time budget: plans have few corrections, and none if the default number is right") {
    const budget_outcome o = run_for(600, {.noise = 0.1});
    CHECK(o.plan.text().size() < 400);
    const budget_outcome constant = run_for(7000 * 1e-3, {.by_pixels = 0, .by_gaussians = 0, .growth = 1}, 0);
    CHECK(constant.seconds == doctest::Approx(7).epsilon(0.03));
}

TEST_CASE("time budget: a run that continues ends in time") {
    gs::train::time_budget budget(10, 1000);
    CHECK_FALSE(budget.correction_at_resume({0, 0, 10}, 7000));
    CHECK_FALSE(budget.correction_at_resume({50, 5, 10}, 100));
    CHECK(budget.correction_at_resume({50, 12, 10}, 100) == 51);   // its time is over
    CHECK(budget.correction_at_resume({100, 5, 10}, 100) == 200);  // finished, with more time
    CHECK_FALSE(budget.correction_at_resume({100, 9.99, 10}, 100));
}

namespace {

/// A small training whose clock advances with each step, or with a noisy clock.
struct trained_run {
    gs::gaussians model;
    gs::train::train_result result;
    std::map<int, gs::state_archive> checkpoints;
};

trained_run trained(const gs::scene& scene, gs::train::train_options o) {
    o.schedule.sh_degree = 1;
    o.schedule.sh_degree_interval = 10;
    auto& adaptive = o.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 10;
    adaptive.densification_interval = 15;
    o.max_cap = 600;
    o.gradient = gs::accumulator::fixed;
    o.checkpoint_every = 10;
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, {}, o.schedule.num_downscales);
    engine->set_model(gs::from_points(scene.points, 1, 300, 1));
    trained_run run;
    double now = 0;
    gs::train::train_events events{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    // The loop asks once per iteration, which takes longer the more Gaussians exist.
    events.is_interrupted = [&] {
        now += 3e-5 * static_cast<double>(engine->count());
        return false;
    };
    events.seconds = [&] { return now; };
    events.checkpoint = [&](int iteration, gs::state_archive& archive) {
        run.checkpoints.insert_or_assign(iteration, gs::state_archive(archive.values(), archive.arrays()));
    };
    run.result = gs::train::train(*engine, scene, o, events);
    run.model = engine->get_model();
    return run;
}

}  // namespace

TEST_CASE("time budget: training with the resulting plan repeats the run bit for bit") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o;
    for (const char* strategy : {"adaptive", "mcmc"}) {
        o.densification.name = strategy;
        o.seconds = 3;
        o.schedule.iterations = 7000;
        const trained_run first = trained(scene, o);
        CAPTURE(first.result.plan.text());
        CHECK(first.result.seconds == doctest::Approx(3).epsilon(0.03));
        CHECK(first.result.plan.is_corrected());
        CHECK(first.model.count() > 300);
        o.seconds.reset();
        o.schedule.iterations = *iteration_plan::parse(first.result.plan.text(), 10000);
        const trained_run again = trained(scene, o);
        CHECK(again.result.plan == first.result.plan);
        check_equal(again.model, first.model);
        for (const int iteration : {50, first.result.iterations}) {
            CAPTURE(iteration);
            gs::state_archive checkpoint = first.checkpoints.at(iteration);
            gs::state_archive loads(checkpoint.values(), checkpoint.arrays());
            o.resume_from = &loads;
            check_equal(trained(scene, o).model, first.model);
        }
        o.resume_from = nullptr;
    }
}

TEST_CASE("time budget: a run that continues from a checkpoint ends in time") {
    const gs::scene scene = small_scene("synthetic:spheres", 24);
    gs::train::train_options o;
    o.seconds = 3;
    const trained_run first = trained(scene, o);
    const int half = first.result.iterations / 20 * 10;
    gs::state_archive checkpoint = first.checkpoints.at(half);
    gs::state_archive loads(checkpoint.values(), checkpoint.arrays());
    o.resume_from = &loads;
    double seconds = 3;
    SUBCASE("the same time") {}
    SUBCASE("more time") { seconds = 4.5; }
    o.seconds = seconds;
    const trained_run rest = trained(scene, o);
    CHECK(rest.result.seconds == doctest::Approx(seconds).epsilon(0.03));
    CHECK(rest.result.plan.text().starts_with(first.result.plan.first_iterations(half - 1).text()));
    auto values = checkpoint.values();
    values.at("training.plan") = "7000,junk";
    gs::state_archive damaged(values, checkpoint.arrays());
    o.resume_from = &damaged;
    CHECK(gs_test::says(gs_test::error_of([&] { trained(scene, o); }), {"plan of iterations", "junk"}));
}
