// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "../train/schedule.hpp"

namespace gs::cli {

/// Says for `--quality fast` what the command line does not: switches that save time, by docs/speed.md.
/// Precondition: `train` has been parsed, into `schedule`.
inline void choose_fast(CLI::App& train, const train::schedule& schedule) {
    const auto choose = [&](const char* name, const std::string& value) {
        CLI::Option* option = train.get_option(name);
        if (option->count() > 0) return;
        option->add_result(value);
        option->run_callback();
    };
    choose("--iterations", "5000");
    choose("--sh-lr", "5e-4");
    choose("--sh-degree-interval", "500");
    if (schedule.iterations > 1) choose("--num-downscales", "1");
    choose("--resolution-schedule",
           std::to_string(std::max(1, schedule.iterations / (4 + std::max(1, schedule.num_downscales)))));
}

}  // namespace gs::cli
