// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "training.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "../core/byte_size.hpp"
#include "../core/error.hpp"
#include "../core/parse_json.hpp"
#include "../core/sanitize_for_message.hpp"
#include "../options/option_value.hpp"
#include "view_order.hpp"

namespace gs::train {

namespace {

std::array<float, 3> random_color(std::mt19937_64& random) {
    const auto channel = [&] { return static_cast<float>(random() >> 40) * 0x1p-24f; };
    const float r = channel(), g = channel(), b = channel();
    return {r, g, b};
}

std::size_t pixels_of(const view& v) {
    return static_cast<std::size_t>(v.camera.width) * static_cast<std::size_t>(v.camera.height);
}

std::size_t pixels_of(const std::vector<view>& views) {
    std::size_t pixels = 0;
    for (const view& v : views) pixels += pixels_of(v);
    return pixels;
}

training_setup setup_of(const scene& scene, const train_options& options, const schedule& schedule) {
    training_setup setup;
    setup.facts.iterations = schedule.iterations;
    setup.facts.views = static_cast<int>(scene.train.size());
    setup.facts.pixels = pixels_of(scene.train);
    setup.facts.extent = schedule.extent;
    setup.facts.white = scene.has_alpha && options.background.color == std::array<float, 3>{1, 1, 1};
    setup.facts.transparent = scene.has_alpha;
    setup.facts.max_gaussians = options.max_cap;
    setup.facts.max_device_bytes = options.max_device_bytes;
    setup.facts.seed = options.seed;
    setup.facts.gradient = options.gradient;
    setup.densification = options.densification;
    setup.loss = options.loss;
    setup.storage = options.storage;
    setup.host_bytes = options.host_bytes;
    setup.dropout = schedule.dropout_share();
    setup.batch_size = options.batch_size;
    for (const auto& feature : options.features.all())
        if (feature.on) setup.features[feature.name] = feature.values;
    return setup;
}

/// Returns the names of the training photos as JSON.
std::string photos_of(const scene& scene) {
    auto names = nlohmann::json::array();
    for (const view& v : scene.train) names.push_back(v.name);
    return names.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

/// Returns the place, the unit and the extent of the scene, which its cameras determine.
std::string cameras_of(const scene& scene) {
    const normalization& n = scene.normalization;
    return nlohmann::json({n.origin.x, n.origin.y, n.origin.z, n.scale, scene.extent()}).dump();
}

/// Throws `error` if the training photos are not those of a checkpoint.
void require_photos(const std::string& in_checkpoint, const scene& scene) {
    if (in_checkpoint == photos_of(scene)) return;
    const auto saved = parse_json(in_checkpoint, "the list of photos in the checkpoint");
    for (std::size_t i = 0; i < std::max(saved.size(), scene.train.size()); ++i) {
        const std::string before = i < saved.size() ? saved[i].dump() : "none",
                          now = i < scene.train.size() ? '"' + scene.train[i].name + '"' : "none";
        if (before != now)
            throw error("the checkpoint belongs to other training photos: photo " + std::to_string(i + 1) +
                        " was " + sanitize_for_message(before) + " and is " + sanitize_for_message(now) +
                        ": restore the photos and the options of the scene, or give --overwrite");
    }
}

void exchange_reports(state_archive& archive, std::map<std::string, nlohmann::ordered_json>& reports) {
    std::string text = nlohmann::ordered_json(reports).dump();
    archive.exchange("reports", text);
    reports.clear();
    const auto saved = parse_json(text, "the value of reports in the checkpoint");
    for (const auto& [name, report] : saved.items()) reports[name] = report;
}

}  // namespace

training::training(train::engine& engine, const gs::scene& scene, const train_options& options,
                   const train_events& events)
    : engine_(engine),
      scene_(scene),
      options_(options),
      schedule_(options.schedule),
      budget_(options.seconds ? std::optional<time_budget>({*options.seconds, options.max_cap})
                              : std::nullopt),
      begins_(events.begins),
      say_(events.say),
      is_interrupted_(events.is_interrupted),
      clock_(events.seconds) {
    schedule_.iterations = options.schedule.iterations.first_iterations(0);
    schedule_.extent = scene.extent();
    schedule_.views = static_cast<int>(scene.train.size());
    schedule_.transparent = scene.has_alpha;
    schedule_.rendered = scene.rendered;
    if (options.batch_size > scene.train.size())
        throw error("--batch-size " + std::to_string(options.batch_size) + ", but there are " +
                    std::to_string(scene.train.size()) + " training photos: give at most as many");
    engine_.begin(setup_of(scene, options, schedule_));
    add_memory();
    add_step();
    add({phase::restructure, "densify", [this](int iteration) { return timetable().due(iteration); },
         [this, warn = events.warn](int iteration) {
             const int on_host_before = engine_.first_degree_on_host();
             result_.without_gradient = std::max(result_.without_gradient, engine_.densify(iteration));
             if (engine_.first_degree_on_host() < on_host_before) warn(moved_to_host(iteration));
             note_limited_growth(iteration, warn);
         }});
    add({phase::upkeep, "adjust parameters", [](int) { return true; },
         [this](int iteration) { engine_.adjust(iteration); }});
    add_reports(events);
}

std::string training::moved_to_host(int iteration) const {
    return "iteration " + std::to_string(iteration) + ": SH coefficients from degree " +
           std::to_string(engine_.first_degree_on_host()) +
           " on lie in host memory, because the device's memory is limited to " +
           size_in_bytes(options_.max_device_bytes) + " (--gpu-memory): steps take longer";
}

/// Warns once if the limit of memory stops growth.
void training::note_limited_growth(int iteration, const std::function<void(const std::string&)>& warn) {
    std::string& by = result_.growth_limited_by;
    if (engine_.lacks_memory()) {
        if (by != "gpu_memory")
            warn("iteration " + std::to_string(iteration) + ": growth stops at " +
                 std::to_string(engine_.count()) + " Gaussians, because the device's memory is limited to " +
                 size_in_bytes(options_.max_device_bytes) + " (--gpu-memory)");
        by = "gpu_memory";
    } else if (by.empty() && engine_.count() >= options_.max_cap) {
        by = "max_cap";
    }
}

void training::add(action action) { actions_.push_back(std::move(action)); }

void training::add_step() {
    const auto order = std::make_shared<view_order>(scene_.train.size(), options_.seed);
    const auto colors = std::make_shared<std::mt19937_64>(options_.seed + 1);
    const std::size_t batch = options_.batch_size;
    add_state([=](state_archive& archive) {
        order->exchange(archive);
        exchange_random(archive, "random_colors", *colors);
    });
    if (photo_prefetch* photos = engine_.streamed_photos(); photos != nullptr)
        add({phase::prepare, "load photos ahead", [](int) { return true; },
             [=, this](int iteration) {
                 std::vector<photos::photo_request> next;
                 for (const std::size_t view : order->upcoming(std::max(photos->look_ahead(), 2 * batch))) {
                     const int needed_in = iteration + static_cast<int>(next.size() / batch);
                     next.push_back({view, static_cast<std::size_t>(schedule_.downscales_at(needed_in))});
                 }
                 photos->expect(std::move(next));
                 lost_photo_ =
                     iteration < schedule_.iterations.last() ? photos->failure_ahead(batch) : nullptr;
                 if (lost_photo_) interrupted_ = true;
             }});
    add({phase::step, "step", [](int) { return true; },
         [=, this](int iteration) {
             step_plan plan;
             plan.iteration = iteration;
             plan.view = order->next();
             std::vector<std::size_t> views(batch - 1);
             for (std::size_t& view : views) view = order->next();
             plan.sh_degree = schedule_.sh_degree_at(iteration);
             plan.updates_sh = schedule_.updates_sh(iteration);
             plan.background = options_.background.random ? random_color(*colors) : options_.background.color;
             plan.rates = schedule_.rates_at(iteration);
             // Zhao et al. 2024 (Grendel, section 4.2) scale rates like this.
             for (float& rate : plan.rates) rate *= std::sqrt(static_cast<float>(batch));
             engine_.step(plan, views);
             views.insert(views.begin(), plan.view);
             faults_.steps(views);
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
    const auto tests = [this](int iteration) { return options_.test_iterations.contains(iteration); };
    const auto saves = [this](int iteration) { return options_.save_iterations.contains(iteration); };
    const auto reports = [=, this](int iteration) {
        return iteration % report_every == 0 || is_last(iteration) || tests(iteration);
    };
    add({phase::observe, "check for faults",
         [=, this](int iteration) {
             return reports(iteration) || saves(iteration) || makes_checkpoint(iteration);
         },
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
             events.report({iteration, schedule_.iterations.last(), mean.loss, mean.psnr(), engine_.count(),
                            seconds()});
         }});
    const auto call = [this](const std::function<void(int)>& callback) {
        return [=, this](int iteration) { call_untimed([&] { callback(iteration); }); };
    };
    add({phase::observe, "test", tests, call(events.test)});
    add_checkpoints(events);
    save_ = call(events.save);
    add({phase::observe, "save", saves, save_});
}

void training::add_checkpoints(const train_events& events) {
    add({phase::observe, "checkpoint", [this](int iteration) { return makes_checkpoint(iteration); },
         [this, make = events.checkpoint](int iteration) {
             call_untimed([&] {
                 finished_ = iteration;
                 state_archive archive;
                 exchange(archive);
                 make(iteration, archive);
             });
         }});
}

void training::call_untimed(const std::function<void()>& callback) {
    engine_.profile().wait();
    const double from = clock_();
    callback();
    outside_ += clock_() - from;
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

void training::exchange(state_archive& archive) {
    {
        const state_archive::scope scope(archive, "training");
        std::string photos = photos_of(scene_);
        archive.exchange("photos", photos);
        require_photos(photos, scene_);
        std::string cameras = cameras_of(scene_);
        archive.exchange("cameras", cameras);
        if (cameras != cameras_of(scene_))
            throw error(
                "the cameras or the points of the scene have changed since the checkpoint: restore the "
                "scene, "
                "or give --overwrite to train from the beginning");
        archive.exchange("iteration", finished_);
        exchange_plan(archive);
        archive.exchange("size_level", level_);
        double seconds_so_far = archive.loads() ? 0 : seconds();
        archive.exchange("seconds", seconds_so_far);
        if (archive.loads()) before_ = seconds_so_far;
        archive.exchange("densify_seconds", result_.densify_seconds);
        archive.exchange("skipped_steps", result_.skipped_steps);
        archive.exchange("without_gradient", result_.without_gradient);
        archive.exchange("growth_limited_by", result_.growth_limited_by);
        exchange_reports(archive, result_.feature_reports);
        faults_.exchange(archive);
        losses_.exchange(archive);
    }
    for (const auto& state : states_before_engine_) state(archive);
    engine_.state().exchange(archive);
    for (const auto& state : states_) state(archive);
}

/// Saves the plan. A run with a time budget also continues with it; other runs have their own plan.
void training::exchange_plan(state_archive& archive) {
    if (archive.loads() && (!budget_ || !archive.has("plan"))) {
        schedule_.iterations.replace(options_.schedule.iterations.first_iterations(finished_));
        return;
    }
    std::string text = schedule_.iterations.text();
    archive.exchange("plan", text);
    const auto plan = iteration_plan::parse(text, static_cast<int>(options::most_iterations));
    if (!plan) throw error("the checkpoint has the plan of iterations " + sanitize_for_message(text));
    schedule_.iterations.replace(*plan);
}

bool training::makes_checkpoint(int iteration) const {
    const bool is_asked = options_.checkpoint_iterations.contains(iteration) ||
                          (options_.checkpoint_every && iteration % *options_.checkpoint_every == 0);
    const bool has_any = options_.checkpoint_every || !options_.checkpoint_iterations.empty();
    return interrupted_ || is_asked || (has_any && is_last(iteration));
}

training_moment training::now() {
    engine_.profile().wait();
    return {finished_, seconds(), engine_.count()};
}

void training::begin_budget() {
    if (!budget_) return;
    // Not `now()`, because a very short budget may be over by then, without a plan.
    const training_moment moment{finished_, before_, engine_.count()};
    if (const auto last = budget_->correction_at_resume(moment, schedule_.iterations.last()))
        schedule_.iterations.correct(finished_, *last);
    budget_->begin(moment, schedule_);
}

void training::correct_plan(int iteration) {
    if (const auto last = options_.schedule.iterations.correction_after(iteration); last && !budget_)
        schedule_.iterations.correct(iteration, *last);
    if (!budget_ || !budget_->due(iteration)) return;
    const training_moment moment = now();
    if (const auto last = budget_->correction(moment, schedule_, timetable().count_is_final_after()))
        schedule_.iterations.correct(iteration, *last);
    budget_->continue_from(moment, schedule_);
}

void training::restore(state_archive& checkpoint) {
    exchange(checkpoint);
    checked_ = finished_;
    level_ = std::min(level_, schedule_.num_downscales);
    if (finished_ < 1) throw error("the checkpoint is from iteration " + std::to_string(finished_));
    if (finished_ > options_.schedule.iterations.last() && !budget_)
        throw error("the checkpoint is from iteration " + std::to_string(finished_) +
                    ", after the last iteration " + std::to_string(options_.schedule.iterations.last()) +
                    ": raise --iterations");
}

train_result training::run() {
    if (finished_ == 0) {
        level_ = schedule_.downscales_at(1);
        engine_.reserve(level_);
    }
    begins_();
    engine_.profile().wait();
    start_ = clock_();
    begin_budget();
    // The checkpoint of an iteration precedes its save, which an interruption can prevent.
    if (options_.save_iterations.contains(finished_)) save_(finished_);
    for (int iteration = finished_ + 1; iteration <= schedule_.iterations.last() && !interrupted_;
         ++iteration) {
        interrupted_ = is_in_any_rank(is_interrupted_());
        restructured_ = false;
        for (const auto phase : {phase::prepare, phase::step, phase::restructure, phase::size_lists,
                                 phase::upkeep, phase::observe})
            run_phase(phase, iteration);
        finished_ = iteration;
        correct_plan(iteration);
    }
    engine_.profile().wait();
    if (options_.ranks != nullptr) options_.ranks->barrier();  // the first one has written its files
    if (lost_photo_) std::rethrow_exception(lost_photo_);
    result_.iterations = finished_;
    result_.plan = schedule_.iterations;
    result_.seconds = seconds();
    result_.left_out_gradients = faults_.left_out_gradients();
    result_.left_out_sums = faults_.left_out_sums();
    return result_;
}

train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events) {
    training training(engine, scene, options, events);
    options.features.schedule(training);
    events.schedule(training);
    if (options.resume_from != nullptr) training.restore(*options.resume_from);
    return training.run();
}

std::size_t default_cap(const scene& scene) {
    return std::max<std::size_t>(pixels_of(scene.train) / 32, 10000);
}

moment_precision precision_in(state_archive& checkpoint) {
    const state_archive::scope engine(checkpoint, "engine"), moments(checkpoint, "moments");
    return checkpoint.has("mean") ? moment_precision::compact : moment_precision::full;
}

int default_downscales(const scene& scene, const schedule& schedule) {
    std::size_t pixels = 0;
    for (const view& v : scene.train) pixels = std::max(pixels, pixels_of(v));
    const auto leaves_whole_photos = [&](int downscales) {
        train::schedule with = schedule;
        with.num_downscales = downscales;
        return downscales * with.resolution_interval() < schedule.iterations.last();
    };
    int downscales = 1;
    while (downscales < 3 && (pixels >> (2 * downscales + 2)) >= 30000 && leaves_whole_photos(downscales + 1))
        ++downscales;
    return downscales;
}

}  // namespace gs::train
