// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <csignal>
#include <utility>

#include "../core/atomic_file_write.hpp"
#include "../core/error.hpp"
#include "../core/parse_json.hpp"
#include "../core/write_json.hpp"
#include "../features/sh_degree/sh_degree_feature.hpp"
#include "../pages/report_page.hpp"
#include "../readers/colmap/write_colmap_model.hpp"
#include "../training/initialize.hpp"
#include "../writers/html/html.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "earlier_run.hpp"
#include "live_training.hpp"
#include "memory_limits.hpp"
#include "progress_bar.hpp"
#include "report.hpp"
#include "run_images.hpp"
#include "scene_with_poses.hpp"
#include "stop_signals.hpp"
#include "train_in_ranks.hpp"
#include "training_effects.hpp"
#include "training_report.hpp"

namespace gs::cli {

namespace {

namespace fs = std::filesystem;

train::train_options options_of(const settings& s, const scene& scene, const command_context& context,
                                const device::profiler& device, const ranks::place& place,
                                features::feature_set features) {
    train::train_options o;
    o.schedule = s.schedule;
    o.schedule.transparent = scene.has_alpha;
    o.schedule.rendered = scene.rendered;
    o.schedule.views = static_cast<int>(scene.train.size());
    o.schedule.num_downscales = s.num_downscales.value_or(train::default_downscales(scene, o.schedule));
    o.seconds = s.seconds;
    o.densification = s.densification;
    o.loss = s.loss;
    o.max_cap =
        s.max_cap.value_or(std::max(train::default_cap(scene), s.densification.target_count().value_or(0)));
    o.seed = s.seed;
    o.max_device_bytes = device_limit(s, device, place);
    o.host_bytes = parameter_bytes_on_host(device, place);
    o.background = context.background(scene.has_alpha && !features.is_on("exposure"));
    o.save_iterations = s.save_iterations;
    o.test_iterations = s.test_iterations;
    o.checkpoint_every = s.checkpoint_every;
    o.checkpoint_iterations = s.checkpoint_iterations;
    o.batch_size = static_cast<std::size_t>(s.batch_size);
    o.features = std::move(features);
    return o;
}

/// A training run. Call its public functions once each, in the order of their declaration.
class training_run {
  public:
    /// Loads the scene from `source`, decides which effects to simulate, and passes the first model
    /// to the engine. Only the first of the ranks writes files, apart from renders of held-out views.
    training_run(const settings& s, const load_options& source, std::unique_ptr<train::engine> engine,
                 accumulator gradient, ranks::communicator& ranks);
    training_run(const training_run&) = delete;
    training_run& operator=(const training_run&) = delete;

    /// Returns false if training was interrupted, except in the first rank, which throws.
    bool train();
    /// Measures the model on the held-out views and writes their renders. The ranks share this work.
    void measure();
    /// The functions below are for the first rank, which is the only one by then.
    void write_reports();
    /// Writes the pages for a browser.
    void write_pages();
    void print_summary() const;

  private:
    train::train_events events();
    /// Returns the seconds since the start. All ranks get the same time.
    double common_seconds() { return ranks_.from_first(loading_.seconds()); }
    bool is_interrupted() const { return signals_->received() != 0 || (live_ && live_->is_stopped()); }
    /// Throws `error` if this rank, on another machine, sees another output folder than the first one.
    void require_same_folder();
    void begin_live_view();
    /// Ends the program after Ctrl-C, or after a page of the live view has asked to stop.
    [[noreturn]] void end_early();
    void say_expected_memory();
    /// Returns the storage of the first model. Training changes it if the model outgrows the limit of memory.
    train::parameter_storage storage(std::optional<train::moment_precision> precision) const {
        const auto forecast = [&](std::size_t gaussians) {
            return engine_->profile().forecast(gaussians, first_sh_degree());
        };
        if (s_.deterministic && !precision) precision = train::moment_precision::full;
        const std::uint64_t limit = options_.max_device_bytes;
        train::parameter_storage chosen = storage_for(
            {engine_->count(), first_sh_degree(), forecast(engine_->count()), limit, options_.host_bytes},
            precision_for(precision, forecast(options_.max_cap), limit));
        // Ranks may have different amounts of free memory.
        chosen.precision = static_cast<train::moment_precision>(
            std::lround(ranks_.from_first(static_cast<double>(chosen.precision))));
        return chosen;
    }
    /// Returns the Gaussians that training begins with. A checkpoint replaces them, so they need no stereo
    /// then.
    gaussians first_model() {
        using enum train::point_source;
        const std::size_t most = options_.densification.target_count().value_or(options_.max_cap);
        const train::point_source any = scene_.points.empty() ? random : given;
        auto first = find_first_points(scene_, checkpoint_ ? any : s_.init, most, s_.seed);
        if (!first.remark.empty() && !checkpoint_) context_.say(first.remark);
        return from_points(std::move(first.points), 0, most, s_.seed);
    }
    int first_sh_degree() const {
        return features::first_sh_degree(options_.features.values_if_on("direction"));
    }
    void warn(const std::string& line);
    /// Returns a model as files have it: in world coordinates, and with the colors of effects.
    gaussians saved_model(gaussians model);
    void save(int iteration);
    /// Sets aside the earlier run that --overwrite replaces. Call it before the first result is
    /// written. `write_reports` removes that run, so that a training that fails loses nothing.
    void replace_earlier_run();
    void test(int iteration);
    void save_checkpoint(int iteration, state_archive& archive);
    void resume();
    /// Warns if the run of --seconds was shorter or longer.
    void warn_of_missed_time();
    nlohmann::ordered_json resolved_settings() const;
    fs::path model_file(int iteration) const;
    fs::path renders_folder() const;

    const settings& s_;
    ranks::communicator& ranks_;
    command_context context_;
    std::optional<checkpoint_folder::found_checkpoint> checkpoint_;  ///< to continue from
    std::optional<stop_signals> signals_;                            ///< while training runs
    std::unique_ptr<train::engine> engine_;
    std::unique_ptr<evaluate::lpips_network> lpips_;
    stopwatch loading_;
    photos::photo_limits limits_;
    scene scene_;
    photos::photo_plan photo_memory_;  ///< empty if photos are resident
    train::train_options options_;
    std::optional<output_folder> output_;  ///< of the first rank
    bool replaces_ = s_.overwrite;         ///< whether an earlier run is still to be set aside
    progress_bar bar_;
    training_measures measures_;
    std::vector<pages::view_images> training_images_;  ///< for the report, if no view is held out
    nlohmann::ordered_json metrics_;                   ///< content of metrics.json
    std::optional<live_training> live_;                ///< while training runs, with --viewer
};

training_run::training_run(const settings& s, const load_options& source,
                           std::unique_ptr<train::engine> engine, accumulator gradient,
                           ranks::communicator& ranks)
    : s_(s),
      ranks_(ranks),
      context_(s),
      checkpoint_(checkpoint_to_resume(s, [this](const std::string& line) { context_.warn(line); })),
      engine_(std::move(engine)),
      lpips_(context_.load_lpips()),
      limits_(photo_limits(s, engine_->profile(), ranks_.place())),
      scene_(context_.load(with_limit(source, limits_))),
      photo_memory_(photo_memory(scene_, limits_, static_cast<std::size_t>(s.batch_size))),
      options_(options_of(s, scene_, context_, engine_->profile(), ranks_.place(),
                          resolve_effects(s, scene_, context_))),
      bar_(s.log_level < log_level::info) {
    if (s.save_cameras) require_colmap_cameras(scene_);
    if (ranks_.is_first()) output_.emplace(s.output);
    require_same_folder();
    options_.gradient = gradient;
    options_.ranks = &ranks_;
    engine_->ranks().join(ranks_);
    gaussians model = first_model();
    options_.features.prepare(scene_, model);
    engine_->set_views(scene_.train, scene_.test, options_.schedule.num_downscales, photo_memory_);
    engine_->set_model(model);
    options_.storage = storage(s.precision);
    measures_.load_seconds = loading_.seconds();
    measures_.device = engine_->profile().device_name();
    if (ranks_.count() > 1) measures_.device += ", " + std::to_string(ranks_.count()) + " ranks";
    context_.say("training on " + measures_.device + ": " + std::to_string(scene_.train.size()) + " views, " +
                 std::to_string(model.count()) + " Gaussians, at most " + std::to_string(options_.max_cap));
    resume();
}

void training_run::require_same_folder() {
    const int own = checkpoint_ ? checkpoint_->iteration : 0;
    const bool is_same = std::lround(ranks_.from_first(own)) == own;
    if (!is_same || !appears(s_.output))
        throw error("the output folder " + s_.output +
                    " is not the one of rank 0: use a folder that all machines share");
}

void training_run::resume() {
    if (!s_.resume) return;
    if (!checkpoint_) {
        context_.say("no checkpoint in " + s_.output + ": training begins");
        return;
    }
    state_archive& archive = checkpoint_->archive;
    std::string settings_text, tests;
    archive.exchange("settings", settings_text);
    archive.exchange("tests", tests);
    archive.exchange("training_psnr", measures_.last.psnr);
    exchange_history(archive, measures_.history);
    measures_.tests = parse_json(tests, "the value of tests in " + checkpoint_->file.string());
    options_.resume_from = &archive;
    options_.storage = storage(train::precision_in(archive));
    if (s_.precision && *s_.precision != options_.storage.precision)
        context_.say("--precision remains " + name_of(options_.storage.precision) + ", as in the checkpoint");
    context_.say("continuing after iteration " + std::to_string(checkpoint_->iteration) + ", from " +
                 checkpoint_->file.string());
    const std::string changes =
        changed_options(parse_json(settings_text, "the value of settings in " + checkpoint_->file.string()),
                        resolved_settings());
    if (!changes.empty()) context_.say("changed options: " + changes);
}

nlohmann::ordered_json training_run::resolved_settings() const {
    return settings_json(resolved(s_, options_, scene_.train.size(), effects_in_use(options_.features)));
}

train::train_events training_run::events() {
    train::train_events events{
        .report =
            [this](const train::progress& p) {
                measures_.last = p;
                measures_.history.push_back(p);
                bar_.show(p);
                if (live_) live_->report(p);
            },
        .save = [this](int iteration) { save(iteration); },
        .test = [this](int iteration) { test(iteration); },
        .warn = [this](const std::string& line) { warn(line); },
        .checkpoint = [this](int iteration, state_archive& archive) { save_checkpoint(iteration, archive); },
        .is_interrupted = [this] { return is_interrupted(); },
        .begins = [this] { say_expected_memory(); },
        .schedule =
            [this](train::training& training) {
                if (live_) live_->add_to(training);
            },
        .say =
            [this](const std::string& line) {
                bar_.clear();
                context_.say(line);
            }};
    if (s_.seconds) events.seconds = [this] { return common_seconds(); };
    return events;
}

void training_run::say_expected_memory() {
    if (photo_memory_.workers > 0)
        context_.say("photos stay in their files: " + std::to_string(photo_memory_.workers) +
                     (photo_memory_.workers == 1 ? " thread decodes" : " threads decode") + " them ahead");
    context_.say(expected_memory(engine_->profile().forecast(options_.max_cap, first_sh_degree()),
                                 options_.max_cap, photos_on_host(scene_, photo_memory_)));
}

void training_run::warn(const std::string& line) {
    bar_.clear();
    context_.warn(line);
}

/// A checkpoint that cannot be written is no reason to end training, except after an interruption.
void training_run::save_checkpoint(int iteration, state_archive& archive) {
    if (!ranks_.is_first()) return;
    std::string tests = measures_.tests.dump();
    std::string settings_text =
        resolved_settings().dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    archive.exchange("settings", settings_text);
    archive.exchange("tests", tests);
    archive.exchange("training_psnr", measures_.last.psnr);
    exchange_history(archive, measures_.history);
    try {
        replace_earlier_run();
        checkpoints_in(s_.output).write(iteration, archive, s_.keep_checkpoints);
    } catch (const std::exception& failed) {
        if (is_interrupted()) throw;
        warn(failed.what() + std::string("; training continues"));
    }
}

void training_run::replace_earlier_run() {
    if (replaces_) set_aside_earlier_run(s_.output);
    replaces_ = false;
}

gaussians training_run::saved_model(gaussians model) {
    options_.features.before_saving(*engine_, scene_, model);
    return to_world(scene_.normalization, model);
}

void training_run::save(int iteration) {
    const gaussians model = engine_->get_model();
    if (!ranks_.is_first()) return;
    replace_earlier_run();
    const fs::path file = model_file(iteration);
    fs::create_directories(file.parent_path());
    write_model(file, saved_model(model));
}

void training_run::test(int iteration) {
    options_.features.before_evaluation(*engine_, scene_);
    const auto report =
        evaluate::measure_held_out_views(*engine_, scene_, options_.background.color, {.ranks = &ranks_});
    measures_.tests.push_back({{"iteration", iteration},
                               {"seconds", measures_.last.seconds},
                               {"psnr", report.psnr()},
                               {"ssim", report.ssim()}});
    bar_.clear();
    context_.say("iteration " + std::to_string(iteration) + ": held-out PSNR " +
                 number("%.2f dB", report.psnr()));
}

void training_run::warn_of_missed_time() {
    constexpr double tolerance = 0.03;
    const double seconds = measures_.result.seconds;
    if (!s_.seconds || std::abs(seconds - *s_.seconds) <= tolerance * *s_.seconds) return;
    const bool is_short = measures_.result.iterations < train::time_budget::first_plan_after;
    warn("training took " + number("%.3g s", seconds) + " instead of " + number("%.3g s", *s_.seconds) +
         (is_short ? ", because the time is too short to plan " +
                         std::to_string(measures_.result.iterations) + " iterations: raise --seconds"
                   : ", because the speed of the machine changed shortly before the end"));
}

void training_run::begin_live_view() {
    if (!s_.viewer) return;
    live_.emplace(s_, *engine_, scene_, options_,
                  live_training::callbacks{.save =
                                               [this](int iteration) {
                                                   save(iteration);
                                                   return model_file(iteration).string();
                                               },
                                           .is_interrupted = [this] { return signals_->received() != 0; }});
}

void training_run::end_early() {
    const int last = measures_.result.iterations;
    if (live_ && live_->is_stopped()) save(last);
    const int signal = signals_->received() != 0 ? signals_->received() : SIGINT;
    throw interruption(signal, "training was interrupted after iteration " + std::to_string(last) +
                                   "; to continue it, add --resume to the same options; to finish it here, "
                                   "also set --iterations " +
                                   std::to_string(last) + (s_.seconds ? " instead of --seconds" : ""));
}

bool training_run::train() {
    signals_.emplace();
    begin_live_view();
    measures_.result = train::train(*engine_, scene_, options_, events());
    const train::train_result& result = measures_.result;
    const bool is_complete = result.iterations >= result.plan.last();
    if (!is_complete && ranks_.is_first()) end_early();
    live_.reset();
    if (is_complete && !options_.save_iterations.contains(result.iterations)) save(result.iterations);
    signals_.reset();
    if (!ranks_.is_first()) return is_complete;
    warn_of_missed_time();
    options_.schedule.iterations = result.plan;
    options_.seconds.reset();
    measures_.stages = engine_->profile().times();
    measures_.pairs_per_iteration = static_cast<double>(engine_->profile().pairs()) / result.iterations;
    measures_.gaussians = engine_->count();
    measures_.traffic = ranks_.traffic();
    return true;
}

void training_run::measure() {
    const stopwatch evaluating;
    // Measures the model with floats that are rounded in world coordinates, as the file stores them.
    engine_->set_model(
        to_internal(scene_.normalization, to_world(scene_.normalization, engine_->get_model())));
    options_.features.before_evaluation(*engine_, scene_);
    measures_.held_out = evaluate::measure_held_out_views(
        *engine_, scene_, options_.background.color,
        {.folder = renders_folder(),
         .fits_exposure = s_.fit_exposure || options_.features.is_on("exposure"),
         .refines_poses = options_.features.is_on("poses") || options_.features.is_on("motion"),
         .network = lpips_.get(),
         .ranks = &ranks_});
    measures_.evaluate_seconds = evaluating.seconds();
    measures_.peak_device_bytes = engine_->profile().peak_device_bytes();
    if (scene_.test.empty())
        training_images_ =
            typical_training_views(*engine_, scene_, options_.features, options_.background.color, ranks_);
}

void training_run::write_reports() {
    metrics_ = metrics_json(s_, measures_);
    metrics_["effects"] = effects_json(s_, scene_, options_, measures_.result);
    write_json(output_->path() / "settings.json", resolved_settings());
    options_.features.write_results(*engine_, scene_, output_->path());
    if (s_.save_cameras)
        write_colmap_model(output_->path() / "cameras" / "sparse" / "0", scene_, [this](std::size_t view) {
            return engine_->cameras().training_camera(view, scene_.train[view].camera);
        });
    write_metrics(output_->path(), metrics_, measures_.held_out);
    remove_replaced_run(output_->path());
}

void training_run::write_pages() {
    const std::string name = last_part(s_.scene.data);
    const std::array<float, 3>& background = options_.background.color;
    pages::report report{{name, metrics_, resolved_settings()}, {}, !scene_.test.empty()};
    report.views = report.are_held_out ? typical_held_out_views(held_out_images_of(output_->path(), metrics_))
                                       : training_images_;
    atomic_file_write(output_->path() / "report.html",
                      [&](std::ostream& out) { pages::write_report_page(out, report); });
    if (!s_.no_viewer)
        write_viewer(output_->path() / "viewer.html", saved_model(engine_->get_model()),
                     viewer_scene_of(scene_, name, background), *s_.viewer_size,
                     [this](const std::string& line) { context_.say(line); });
}

void training_run::print_summary() const {
    const std::string count = std::to_string(measures_.gaussians);
    if (const auto direction = measures_.result.feature_reports.find("direction");
        direction != measures_.result.feature_reports.end() &&
        direction->second.contains("gaussians_with_bands"))
        context_.say(std::to_string(measures_.gaussians -
                                    direction->second["gaussians_with_bands"].get<std::size_t>()) +
                     " of " + count + " Gaussians have one color in all directions");
    const evaluate::held_out_report& report = measures_.held_out;
    const std::size_t views = report.views.size();
    if (views == 0) {
        context_.say("training PSNR " + number("%.2f dB", measures_.last.psnr) +
                     " (no held-out views without --eval)");
    } else {
        const fs::path first = evaluate::render_names(scene_.test).front();
        context_.say("held-out PSNR " + number("%.2f dB", report.psnr()) + ", SSIM " +
                     number("%.4f", report.ssim()) + optional_measures(report) + " over " +
                     std::to_string(views) + " views");
        context_.say("renders   " + (renders_folder() / "renders" / first).string() +
                     (views > 1 ? " and " + std::to_string(views - 1) + " more" : ""));
    }
    context_.say("model     " + model_file(measures_.result.iterations).string());
    context_.say("report    " + (output_->path() / "report.html").string());
    if (!s_.no_viewer) context_.say("viewer    " + (output_->path() / "viewer.html").string());
    context_.say("metrics   " + (output_->path() / "metrics.json").string());
}

fs::path training_run::model_file(int iteration) const {
    return output_->path() / "point_cloud" / ("iteration_" + std::to_string(iteration)) / "point_cloud.ply";
}

fs::path training_run::renders_folder() const {
    return fs::path(s_.output) / "test" / ("ours_" + std::to_string(measures_.result.iterations));
}

}  // namespace

void train(const settings& s) {
    if (s.mpi) return train_with_mpi(s);
    require_single_process();
    if (s.ranks > 1 || s.gpus != 1) return train_in_ranks(s);
    ranks::communicator alone;
    train(s, command_context(s).make_engine(), s.deterministic ? accumulator::fixed : accumulator::native,
          alone);
}

void train(const settings& s, std::unique_ptr<train::engine> engine, accumulator gradient,
           ranks::communicator& ranks) {
    require_no_earlier_run(s);
    training_run run(s, scene_with_poses(s), std::move(engine), gradient, ranks);
    if (!run.train()) return;
    run.measure();
    if (!ranks.is_first()) return;
    run.write_reports();
    run.write_pages();
    run.print_summary();
}

}  // namespace gs::cli
