// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace gs::cli {

/// Says for `--quality` what the command line does not: `fast` takes less time, `best` as much as it
/// takes, by docs/gaussian_splatting.md. Precondition: `train` has been parsed.
inline void choose_quality(CLI::App& train, const std::string& quality) {
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
    }
    if (quality == "best") {
        choose("--iterations", "30000");
        if (!is_said("--budget")) choose("--densify-grad-threshold", "5e-5");
    }
}

}  // namespace gs::cli
