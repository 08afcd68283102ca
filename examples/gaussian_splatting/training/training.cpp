// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "training.hpp"

#include <algorithm>
#include <memory>
#include <random>
#include <utility>

#include "view_order.hpp"

namespace gs::train {

namespace {

std::array<float, 3> random_color(std::mt19937_64& random) {
    const auto channel = [&] { return static_cast<float>(random() >> 40) * 0x1p-24f; };
    const float r = channel(), g = channel(), b = channel();
    return {r, g, b};
}

training_setup setup_of(const scene& scene, const train_options& options, const schedule& schedule) {
    training_setup setup;
    setup.facts.iterations = schedule.iterations;
    setup.facts.views = static_cast<int>(scene.train.size());
    setup.facts.extent = schedule.extent;
    setup.facts.white = scene.has_alpha && options.background.color == std::array<float, 3>{1, 1, 1};
    setup.facts.transparent = scene.has_alpha;
    setup.facts.max_gaussians = options.max_cap;
    setup.facts.seed = options.seed;
    setup.facts.gradient = options.gradient;
    setup.densification = options.densification;
    setup.loss = options.loss;
    setup.dropout = schedule.dropout_share();
    for (const auto& feature : options.features.all())
        if (feature.on) setup.features[feature.name] = feature.values;
    return setup;
}

}  // namespace

training::training(train::engine& engine, const gs::scene& scene, const train_options& options,
                   const train_events& events)
    : engine_(engine), scene_(scene), options_(options), schedule_(options.schedule), clock_(events.seconds) {
    schedule_.extent = scene.extent();
    schedule_.transparent = scene.has_alpha;
    engine_.begin(setup_of(scene, options, schedule_));
    add_step();
    add_memory();
    add({phase::restructure, "densify", [this](int iteration) { return timetable().due(iteration); },
         [this](int iteration) {
             result_.without_gradient = std::max(result_.without_gradient, engine_.densify(iteration));
         }});
    add({phase::upkeep, "adjust parameters", [](int) { return true; },
         [this](int iteration) { engine_.adjust(iteration); }});
    add_reports(events);
}

void training::add(action action) { actions_.push_back(std::move(action)); }

void training::add_step() {
    const auto order = std::make_shared<view_order>(scene_.train.size(), options_.seed);
    const auto colors = std::make_shared<std::mt19937_64>(options_.seed + 1);
    add({phase::step, "step", [](int) { return true; },
         [=, this](int iteration) {
             step_plan plan;
             plan.iteration = iteration;
             plan.view = order->next();
             plan.sh_degree = schedule_.sh_degree_at(iteration);
             plan.updates_sh = schedule_.updates_sh(iteration);
             plan.background = options_.background.random ? random_color(*colors) : options_.background.color;
             plan.rates = schedule_.rates_at(iteration);
             engine_.step(plan);
             faults_.steps(plan.view);
         }});
}

void training::add_memory() {
    constexpr int reserve_every = 500;  // iterations; lists grow slowly between densifications
    add({phase::prepare, "change the photos' size",
         [this](int iteration) { return schedule_.downscales_at(iteration) != level_; },
         [this](int iteration) {
             level_ = schedule_.downscales_at(iteration);
             engine_.reserve(level_);
         }});
    add({phase::size_lists, "size the tile lists",
         [this](int iteration) { return restructured_ || iteration % reserve_every == 0; },
         [this](int) { engine_.reserve(level_); }});
}

void training::add_reports(const train_events& events) {
    constexpr int report_every = 100;
    const int last = schedule_.iterations;
    const auto tests = [this](int iteration) { return options_.test_iterations.contains(iteration); };
    const auto saves = [this](int iteration) { return options_.save_iterations.contains(iteration); };
    const auto reports = [=](int iteration) {
        return iteration % report_every == 0 || iteration == last || tests(iteration);
    };
    add({phase::observe, "check for faults",
         [=](int iteration) { return reports(iteration) || saves(iteration); },
         [=, this](int iteration) {
             const step_report report = engine_.take_report();
             const auto steps = static_cast<std::uint64_t>(iteration - checked_);
             losses_.add(report.loss, steps - report.skipped);
             checked_ = iteration;
             result_.skipped_steps += report.skipped;
             faults_.check(report.faults, scene_, iteration, events.warn);
         }});
    add({phase::observe, "report", reports, [=, this](int iteration) {
             const loss_report mean = losses_.take();
             events.report(
                 {iteration, last, mean.loss, mean.psnr(), engine_.count(), clock_() - start_ - outside_});
         }});
    const auto call = [this](const std::function<void(int)>& callback) {
        return [=, this](int iteration) {
            engine_.profile().wait();
            const double from = clock_();
            callback(iteration);
            outside_ += clock_() - from;
        };
    };
    add({phase::observe, "test", tests, call(events.test)});
    add({phase::observe, "save", saves, call(events.save)});
}

void training::run_phase(train::phase phase, int iteration) {
    const bool timed = phase == phase::restructure || phase == phase::size_lists;
    for (const action& a : actions_) {
        if (a.phase != phase || !a.due(iteration)) continue;
        if (timed) engine_.profile().wait();
        const double from = clock_();
        a.run(iteration);
        if (phase == phase::restructure) restructured_ = true;
        if (timed) result_.densify_seconds += clock_() - from;
    }
}

train_result training::run() {
    level_ = schedule_.downscales_at(1);
    engine_.reserve(level_);
    engine_.profile().wait();
    start_ = clock_();
    for (int iteration = 1; iteration <= schedule_.iterations; ++iteration) {
        restructured_ = false;
        for (const auto phase : {phase::prepare, phase::step, phase::restructure, phase::size_lists,
                                 phase::upkeep, phase::observe})
            run_phase(phase, iteration);
    }
    engine_.profile().wait();
    result_.seconds = clock_() - start_ - outside_;
    result_.left_out_gradients = faults_.left_out_gradients();
    result_.left_out_sums = faults_.left_out_sums();
    return result_;
}

train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events) {
    training training(engine, scene, options, events);
    options.features.schedule(training);
    return training.run();
}

std::size_t default_cap(const scene& scene) {
    std::size_t pixels = 0;
    for (const view& v : scene.train)
        pixels += static_cast<std::size_t>(v.camera.width) * static_cast<std::size_t>(v.camera.height);
    return std::max<std::size_t>(pixels / 32, 10000);
}

}  // namespace gs::train
