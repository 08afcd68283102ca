// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "../train/schedule.hpp"

namespace gs::cli {

/// Says for `--quality` what the command line does not: `fast` takes switches that save time, `best` the time
/// that it takes, by docs/gaussian_splatting.md. Precondition: `train` has been parsed, into `schedule`.
inline void choose_quality(CLI::App& train, const std::string& quality, const train::schedule& schedule) {
    const auto is_said = [&](const char* name) { return train.get_option(name)->count() > 0; };
    const auto choose = [&](const char* name, const std::string& value) {
        if (is_said(name)) return;
        CLI::Option* option = train.get_option(name);
        option->add_result(value);
        option->run_callback();
    };
    if (quality == "fast") {
        choose("--iterations", "5000");
        choose("--sh-lr", "5e-4");
        choose("--sh-degree-interval", "500");
        if (schedule.iterations > 1) choose("--num-downscales", "1");
        choose("--resolution-schedule",
               std::to_string(std::max(1, schedule.iterations / (4 + std::max(1, schedule.num_downscales)))));
    }
    if (quality == "best") {
        choose("--iterations", "30000");
        if (!is_said("--budget")) choose("--densify-grad-threshold", "5e-5");
    }
}

}  // namespace gs::cli
