// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "../engine/engine.hpp"
#include "../features/resolve.hpp"
#include "fault_log.hpp"
#include "schedule.hpp"

namespace gs::train {

/// What to train against in the transparent parts of photos.
struct background_choice {
    std::array<float, 3> color{};
    bool random = false;  ///< another color in every step; held-out views are measured on `color`
};

struct train_options {
    train::schedule schedule;
    strategy_settings densification;
    std::size_t max_cap = 0;  ///< most Gaussians
    std::string loss = default_loss;
    std::uint64_t seed = 0;
    accumulator gradient = accumulator::native;
    background_choice background;
    features::feature_set features;
    std::set<int> save_iterations;
    std::set<int> test_iterations;
};

/// Where training stands.
struct progress {
    int iteration = 0, iterations = 0;
    double loss = 0, psnr = 0;  ///< means over the latest training steps
    std::size_t gaussians = 0;
    double seconds = 0;
};

struct train_result {
    double seconds = 0;          ///< in the loop, without callbacks
    double densify_seconds = 0;  ///< of these, in the phases `restructure` and `size_lists`
    std::uint64_t skipped_steps = 0;
    std::uint64_t left_out_gradients = 0;  ///< elements that were not finite
    std::uint64_t left_out_sums = 0;       ///< steps in which a sum did not fit in fixed point
    std::uint64_t without_gradient = 0;    ///< largest number at any densification; see `engine::densify`
    std::map<std::string, nlohmann::ordered_json> feature_reports;  ///< by feature, for metrics.json
};

/// What the loop calls back for.
struct train_events {
    std::function<void(const progress&)> report;  ///< also before `test`
    std::function<void(int iteration)> save;
    std::function<void(int iteration)> test;
    std::function<void(const std::string&)> warn = [](const std::string&) {};
    /// The clock that times the run, in seconds from any start.
    std::function<double()> seconds = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
};

/// The mean loss over steps of several reports of the engine.
class mean_loss {
  public:
    void add(const loss_report& report, std::uint64_t steps) {
        if (steps == 0) return;
        const auto weight = static_cast<double>(steps);
        sum_.loss += weight * report.loss;
        sum_.square_error += weight * report.square_error;
        weight_ += weight;
    }
    /// The mean of what was added since the last call.
    loss_report take() {
        const loss_report mean{sum_.loss / weight_, sum_.square_error / weight_};
        *this = {};
        return mean;
    }

  private:
    loss_report sum_;
    double weight_ = 0;
};

/// When an action runs within an iteration. Actions of one phase run in the order in which they were added.
enum class phase {
    prepare,      ///< before the step
    step,         ///< the step itself
    restructure,  ///< changes the number or the layout of parameters
    size_lists,   ///< sizes the tile lists for what changed
    upkeep,       ///< changes parameters in place
    observe       ///< looks at the result: faults, progress, tests, files
};

struct action {
    train::phase phase;
    std::string name;
    std::function<bool(int iteration)> due;
    std::function<void(int iteration)> run;
};

/// The training loop: a list of scheduled actions, run for each iteration.
class training {
  public:
    /// Precondition: `engine` has the scene's views and a model.
    training(train::engine& engine, const gs::scene& scene, const train_options& options,
             const train_events& events);

    void add(action action);
    /// Runs all iterations. A gradient that is not finite is left out of its step, and a warning names the
    /// first. A loss that is not finite, or a parameter that would not be, ends training: throws `error` that
    /// names the iteration, the view and the parameter. What was saved before stays. The device notes such
    /// faults in the iteration in which they appear; the loop looks at them every 100 iterations and before
    /// anything is tested or saved.
    train_result run();

    train::engine& engine() { return engine_; }
    const gs::scene& scene() const { return scene_; }
    const train_options& options() const { return options_; }
    train::schedule& schedule() { return schedule_; }
    const train::timetable& timetable() const { return engine_.timetable(); }
    train_result& result() { return result_; }

  private:
    void add_step();
    void add_memory();
    void add_reports(const train_events& events);
    void run_phase(train::phase phase, int iteration);

    train::engine& engine_;
    const gs::scene& scene_;
    const train_options& options_;
    train::schedule schedule_;
    std::vector<action> actions_;
    train_result result_;
    int level_ = 0;              ///< how many times photos are halved
    bool restructured_ = false;  ///< in this iteration
    fault_log faults_;
    int checked_ = 0;  ///< the last iteration that was checked for faults
    mean_loss losses_;
    std::function<double()> clock_;
    double start_ = 0, outside_ = 0;  ///< seconds at the start, and in callbacks
};

/// Trains the model that `engine` holds with the features of `options`. See `training`.
train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events);

/// As many Gaussians as the photos can tell apart: one per 32 pixels of all training views, and at least
/// 10,000.
std::size_t default_cap(const scene& scene);

}  // namespace gs::train
