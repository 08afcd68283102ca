// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "../device/stages.hpp"
#include "../evaluation/held_out_views.hpp"
#include "../training/training.hpp"
#include "settings.hpp"

namespace gs::cli {

/// The measures of a training run.
struct training_measures {
    double load_seconds = 0, evaluate_seconds = 0;
    train::progress last;                                            ///< at the end of training
    nlohmann::ordered_json tests = nlohmann::ordered_json::array();  ///< those of --test-iterations
    train::train_result result;
    device::stage_times stages;
    double pairs_per_iteration = 0;  ///< of pixels and Gaussians
    std::size_t gaussians = 0;
    std::size_t peak_device_bytes = 0;
    std::string device;
    evaluate::held_out_report held_out;
};

/// The settings with the values that dependent defaults came to.
settings resolved(settings s, const train::train_options& options, const std::string& effects_in_use);

/// All options of train and their values, for settings.json.
nlohmann::ordered_json settings_json(settings s);

/// metrics.json without the effects.
nlohmann::ordered_json metrics_json(const settings& s, const training_measures& measures);

}  // namespace gs::cli
