// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../device/stages.hpp"
#include "../evaluation/held_out_views.hpp"
#include "../ranks/traffic.hpp"
#include "../training/training.hpp"
#include "settings.hpp"

namespace gs::cli {

/// The measurements of a training run.
struct training_measures {
    double load_seconds = 0, evaluate_seconds = 0;
    std::vector<train::progress> history;                            ///< all reports of training
    train::progress last;                                            ///< after the last iteration
    nlohmann::ordered_json tests = nlohmann::ordered_json::array();  ///< of --test-iterations
    train::train_result result;
    device::stage_times stages;
    double pairs_per_iteration = 0;  ///< pairs of a pixel and a Gaussian
    std::size_t gaussians = 0;
    std::size_t peak_device_bytes = 0;
    std::string device;
    evaluate::held_out_report held_out;
    ranks::traffic_counter traffic{1};  ///< between the ranks, until the end of training
};

/// Returns the settings with the values of dependent defaults. `views` is the number of training
/// views. If `options` have a plan of iterations in place of --seconds, so do the settings.
settings resolved(settings s, const train::train_options& options, std::size_t views,
                  const std::string& effects_in_use);

/// Returns all options of train with their values, for settings.json.
nlohmann::ordered_json settings_json(settings s);

/// Returns the content of metrics.json without the effects.
nlohmann::ordered_json metrics_json(const settings& s, const training_measures& measures);

/// Saves or loads the reports of training for checkpoints.
void exchange_history(state_archive& archive, std::vector<train::progress>& history);

}  // namespace gs::cli
