// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../engine/engine.hpp"
#include "../features/resolve.hpp"
#include "fault_log.hpp"
#include "schedule.hpp"
#include "time_budget.hpp"

namespace gs::train {

/// The background of renders, and of the transparent parts of photos.
struct background_choice {
    std::array<float, 3> color{};
    bool random = false;  ///< random color in each step; held-out views use `color`
};

struct train_options {
    train::schedule schedule;
    /// If set, training lasts about this long: it corrects the plan of `schedule` while it runs.
    std::optional<double> seconds;
    strategy_settings densification;
    std::size_t max_cap = 0;             ///< largest number of Gaussians
    std::uint64_t max_device_bytes = 0;  ///< see `training_facts::max_device_bytes`
    std::string loss = default_loss;
    parameter_storage storage{};
    std::uint64_t host_bytes = 0;  ///< see `training_setup::host_bytes`
    std::size_t batch_size = 1;    ///< number of views of each iteration
    std::uint64_t seed = 0;
    accumulator gradient = accumulator::native;
    background_choice background;
    features::feature_set features;
    std::set<int> save_iterations;
    std::set<int> test_iterations;
    /// The iterations after which training passes a checkpoint to `train_events::checkpoint`. If
    /// there are any, it also passes one at the end.
    /// @{
    std::optional<int> checkpoint_every;  ///< iterations between two checkpoints
    std::set<int> checkpoint_iterations;
    /// @}
    ranks::communicator* ranks = nullptr;  ///< the processes that train this model, or null for one
    state_archive* resume_from = nullptr;  ///< state of a checkpoint to continue from, or null
};

/// Returns the precision of the moments in a checkpoint.
moment_precision precision_in(state_archive& checkpoint);

/// The progress of a training run.
struct progress {
    int iteration = 0, iterations = 0;
    double loss = 0, psnr = 0;  ///< means over the steps since the last report
    std::size_t gaussians = 0;
    double seconds = 0;  ///< without the callbacks that `training::call_untimed` calls
};

struct train_result {
    int iterations = 0;          ///< last iteration; less than planned if training was interrupted
    iteration_plan plan;         ///< with all corrections; training with it needs no clock
    double seconds = 0;          ///< time of the loop, without what `training::call_untimed` calls
    double densify_seconds = 0;  ///< part of it in the phases `restructure` and `size_lists`
    std::uint64_t skipped_steps = 0;
    std::uint64_t left_out_gradients = 0;  ///< number of elements that were not finite
    std::uint64_t left_out_sums = 0;       ///< number of steps with a sum out of range
    std::uint64_t without_gradient = 0;    ///< largest result of `engine::densify`
    std::string growth_limited_by;         ///< option that stopped growth, such as "gpu_memory", or empty
    std::map<std::string, nlohmann::ordered_json> feature_reports;  ///< parts of metrics.json
};

class training;

/// The callbacks of the training loop.
struct train_events {
    /// Called every 100 iterations, at the end, and before each `test`.
    std::function<void(const progress&)> report;
    std::function<void(int iteration)> save;
    std::function<void(int iteration)> test;
    std::function<void(const std::string&)> warn = [](const std::string&) {};
    /// The clock of the reported times, in seconds since any fixed time.
    std::function<double()> seconds = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    /// Called with the state for `train_options::resume_from`. The callback may add values.
    std::function<void(int iteration, state_archive&)> checkpoint = [](int, state_archive&) {};
    /// Called in each iteration. If it returns true in any rank, training makes a checkpoint after the
    /// iteration and ends.
    std::function<bool()> is_interrupted = [] { return false; };
    /// Called before the first iteration, after memory for it has been reserved.
    std::function<void()> begins = [] {};
    /// Called before the training is restored or begins, to add actions.
    std::function<void(training&)> schedule = [](training&) {};
    /// Called with a line for the user about a decision during training.
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// The mean loss over the steps of several reports of the engine.
class mean_loss {
  public:
    void add(const loss_report& report, std::uint64_t steps) {
        if (steps == 0) return;
        const auto weight = static_cast<double>(steps);
        sum_.loss += weight * report.loss;
        sum_.square_error += weight * report.square_error;
        weight_ += weight;
    }
    void exchange(state_archive& archive) {
        archive.exchange("loss", sum_.loss);
        archive.exchange("square_error", sum_.square_error);
        archive.exchange("loss_weight", weight_);
    }
    /// Returns the mean over the steps that were added since the last call. It is NaN if
    /// there were no steps.
    loss_report take() {
        const loss_report mean{sum_.loss / weight_, sum_.square_error / weight_};
        *this = {};
        return mean;
    }

  private:
    loss_report sum_;
    double weight_ = 0;
};

/// The phases of an iteration, in their order. Actions of one phase run in the order in which they
/// were added.
enum class phase {
    prepare,      ///< before the step
    step,         ///< the step itself
    restructure,  ///< changes the number or the layout of parameters
    size_lists,   ///< sizes the tile lists after such changes
    upkeep,       ///< changes parameters in place
    observe       ///< observes the result: faults, progress, tests, files
};

struct action {
    train::phase phase;
    std::string name;
    std::function<bool(int iteration)> due;
    std::function<void(int iteration)> run;
};

/// The training loop: a list of actions that run in the iterations in which they are due.
class training {
  public:
    /// Calls `engine::begin`, and adds the actions that every training has. `engine`, `scene` and
    /// `options` must outlive the object. Precondition: `engine` has the scene's views and a model.
    training(train::engine& engine, const gs::scene& scene, const train_options& options,
             const train_events& events);

    /// Adds an action to the end of its phase.
    void add(action action);
    /// Adds state that later iterations depend on. Checkpoints contain what `exchange` passes to the
    /// archive.
    void add_state(std::function<void(state_archive&)> exchange) { states_.push_back(std::move(exchange)); }
    /// Adds state like `add_state`, which a checkpoint restores before the state of the engine. It decides
    /// which parts the engine has.
    void add_state_before_engine(std::function<void(state_archive&)> exchange) {
        states_before_engine_.push_back(std::move(exchange));
    }
    /// Continues from a checkpoint: `run` begins after its iteration. Call it after all actions and
    /// states have been added. Throws `error` if the checkpoint belongs to other photos, or to a
    /// later iteration than the last one.
    void restore(state_archive& checkpoint);
    /// Runs all iterations that are left. Steps leave out gradients that are not finite; a warning names the
    /// first one. If the loss is not finite, or a parameter would not be finite, throws an `error`
    /// that names the iteration, the view and the parameter. Earlier saves remain valid.
    ///
    /// The device records such faults in the iteration in which they occur. The loop checks for
    /// them every 100 iterations, at the end, and before each test and save.
    train_result run();
    /// Calls a function whose time does not count as time of training. Waits for the device before.
    void call_untimed(const std::function<void()>& callback);
    /// Tells the user about a decision during training.
    void say(const std::string& line) const { say_(line); }

    train::engine& engine() { return engine_; }
    const gs::scene& scene() const { return scene_; }
    const train_options& options() const { return options_; }
    train::schedule& schedule() { return schedule_; }
    const train::timetable& timetable() const { return engine_.timetable(); }
    train_result& result() { return result_; }

  private:
    /// Returns a warning for the user.
    std::string moved_to_host(int iteration) const;
    void note_limited_growth(int iteration, const std::function<void(const std::string&)>& warn);
    void add_step();
    void add_memory();
    void add_reports(const train_events& events);
    void add_checkpoints(const train_events& events);
    bool makes_checkpoint(int iteration) const;
    bool is_in_any_rank(bool flag) const {
        return options_.ranks == nullptr ? flag : options_.ranks->any(flag);
    }
    bool is_last(int iteration) const { return iteration == schedule_.iterations.last(); }
    void begin_budget();
    void correct_plan(int iteration);
    training_moment now();
    void exchange(state_archive& archive);
    void exchange_plan(state_archive& archive);
    void run_phase(train::phase phase, int iteration);
    double seconds() const { return before_ + clock_() - start_ - outside_; }

    train::engine& engine_;
    const gs::scene& scene_;
    const train_options& options_;
    train::schedule schedule_;
    std::optional<time_budget> budget_;
    std::vector<action> actions_;
    std::vector<std::function<void(state_archive&)>> states_before_engine_, states_;
    std::function<void(int iteration)> save_;
    int finished_ = 0;  ///< last finished iteration
    std::function<void()> begins_;
    std::function<void(const std::string&)> say_;
    std::function<bool()> is_interrupted_;
    bool interrupted_ = false;       ///< whether training ends after this iteration
    std::exception_ptr lost_photo_;  ///< why the photo of the next step cannot be decoded, or null
    train_result result_;
    int level_ = 0;              ///< size level: photos are halved this many times
    bool restructured_ = false;  ///< whether the phase `restructure` has acted in this iteration
    fault_log faults_;
    int checked_ = 0;  ///< last iteration that was checked for faults
    mean_loss losses_;
    std::function<double()> clock_;
    /// Time of the start, seconds spent in callbacks, and seconds before the checkpoint.
    double start_ = 0, outside_ = 0, before_ = 0;
};

/// Trains the model of `engine` with the features of `options`. See `training`.
train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events);

/// Returns the default limit of the number of Gaussians: one per 32 pixels of all training views,
/// and at least 10,000.
std::size_t default_cap(const scene& scene);

/// Returns the default of `schedule::num_downscales`: how often the largest training view can be
/// halved and keep 30,000 pixels, at least once, at most three times, and not so often that training
/// ends before the photos are whole.
int default_downscales(const scene& scene, const schedule& schedule);

}  // namespace gs::train
