// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "training_report.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <type_traits>

#include "../features/sh_degree/sh_degree_feature.hpp"
#include "config_file.hpp"
#include "option_table.hpp"
#include "report.hpp"

namespace gs::cli {

namespace {

using nlohmann::ordered_json;

/// Returns, for each stage of an iteration, the time in milliseconds, and in nanoseconds per pair
/// of a pixel and a Gaussian.
ordered_json stages_json(const device::stage_times& times, double pairs_per_iteration) {
    ordered_json stages;
    for (std::size_t i = 0; i < device::stage_names.size(); ++i) {
        const double ms = times.milliseconds[i] / std::max(times.sampled, 1);
        stages[device::stage_names[i]] = {{"milliseconds", ms},
                                          {"nanoseconds_per_pair", ms * 1e6 / pairs_per_iteration}};
    }
    return stages;
}

/// Returns the traffic as means per step, and the bytes as those that a rank sends in the mean.
ordered_json exchange_json(const ranks::traffic_counter& traffic) {
    const auto steps = static_cast<double>(traffic.steps());
    ordered_json bytes, calls;
    for (std::size_t p = 0; p < ranks::purpose_names.size(); ++p) {
        const auto& amount = traffic.of(static_cast<ranks::purpose>(p));
        bytes[ranks::purpose_names[p]] = static_cast<double>(amount.bytes) / (steps * traffic.ranks());
        calls[ranks::purpose_names[p]] = static_cast<double>(amount.calls) / steps;
    }
    return {{"ranks", traffic.ranks()},
            {"steps", traffic.steps()},
            {"visible_splats", static_cast<double>(traffic.splats()) / steps},
            {"sent_splats", static_cast<double>(traffic.sent()) / steps / traffic.ranks()},
            {"largest_share", static_cast<double>(traffic.largest_shares()) / steps},
            {"bytes", bytes},
            {"calls", calls}};
}

std::size_t peak_host_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// Returns the reports as columns.
ordered_json history_json(const std::vector<train::progress>& history) {
    const auto column = [&](const auto& value_of) {
        ordered_json values = ordered_json::array();
        for (const train::progress& p : history) values.push_back(value_of(p));
        return values;
    };
    return {{"iteration", column([](const train::progress& p) { return p.iteration; })},
            {"seconds", column([](const train::progress& p) { return p.seconds; })},
            {"loss", column([](const train::progress& p) { return p.loss; })},
            {"psnr", column([](const train::progress& p) { return p.psnr; })},
            {"gaussians", column([](const train::progress& p) { return p.gaussians; })}};
}

}  // namespace

settings resolved(settings s, const train::train_options& options, std::size_t views,
                  const std::string& effects_in_use) {
    const train::schedule& plan = options.schedule;
    s.schedule = plan;
    s.schedule.position_lr_init = plan.position_rate_init();
    s.schedule.position_lr_final = plan.position_rate_final();
    s.schedule.sh_lr = plan.sh_rate();
    s.schedule.dropout = plan.dropout_share();
    s.schedule.resolution_schedule = plan.resolution_interval();
    s.densification = options.densification.resolved({.iterations = plan.iterations,
                                                      .views = static_cast<int>(views),
                                                      .transparent = plan.transparent,
                                                      .seed = s.seed});
    s.sh_degree = features::first_sh_degree(options.features.values_if_on("direction"));
    s.effects.text = effects_in_use;
    s.max_cap = options.max_cap;
    s.precision = options.storage.precision;
    s.num_downscales = plan.num_downscales;
    s.save_iterations = options.save_iterations;
    s.save_iterations.insert(plan.iterations.last());
    s.seconds = options.seconds;
    return s;
}

ordered_json settings_json(settings s) {
    ordered_json all;
    for (const option& row : option_table(s))
        if (row.belongs_to(command::train) && row.is_recorded &&
            (row.strategy.empty() || row.strategy == s.densification.name))
            all[row.key()] = row.value.json();
    if (!s.seconds && s.given.contains("seconds")) {
        s.given.erase("seconds");
        s.given["iterations"] = all.at("iterations");
    }
    all[given_options_key] = s.given;
    return all;
}

ordered_json metrics_json(const settings& s, const training_measures& measures) {
    const train::train_result& result = measures.result;
    const int iterations = result.iterations;
    ordered_json metrics = to_json(measures.held_out);
    metrics.update(
        {{"training_psnr", measures.last.psnr},
         {"tests", measures.tests},
         {"history", history_json(measures.history)},
         {"iterations", iterations},
         {"gaussians", measures.gaussians},
         {"seconds",
          {{"load", measures.load_seconds},
           {"train", result.seconds},
           {"evaluate", measures.evaluate_seconds}}},
         {"iterations_per_second", iterations / result.seconds},
         {"densify_seconds", result.densify_seconds},
         {"skipped_steps", result.skipped_steps},
         {"left_out_gradients", result.left_out_gradients},
         {"left_out_sums", result.left_out_sums},
         {"gaussians_without_gradient", result.without_gradient},
         {"pairs_per_iteration", measures.pairs_per_iteration},
         {"stages", stages_json(measures.stages, measures.pairs_per_iteration)},
         {"peak_host_bytes", peak_host_bytes()},
         {"peak_device_bytes", measures.peak_device_bytes},
         {"growth_limited_by",
          result.growth_limited_by.empty() ? ordered_json(nullptr) : ordered_json(result.growth_limited_by)},
         {"device", measures.device},
         {"accumulator", s.deterministic ? "fixed" : "native"},
         {"deterministic", s.deterministic},
         {"seed", s.seed}});
    if (measures.traffic.steps() > 0) metrics["exchange"] = exchange_json(measures.traffic);
    return metrics;
}

void exchange_history(state_archive& archive, std::vector<train::progress>& history) {
    const state_archive::scope scope(archive, "history");
    const auto exchange = [&](const char* name, auto member) {
        using value = std::remove_reference_t<decltype(history.front().*member)>;
        std::vector<value> column;
        for (const train::progress& p : history) column.push_back(p.*member);
        archive.exchange(name, column);
        history.resize(column.size());
        for (std::size_t i = 0; i < column.size(); ++i) history[i].*member = column[i];
    };
    exchange("iteration", &train::progress::iteration);
    exchange("seconds", &train::progress::seconds);
    exchange("loss", &train::progress::loss);
    exchange("psnr", &train::progress::psnr);
    exchange("gaussians", &train::progress::gaussians);
}

}  // namespace gs::cli
