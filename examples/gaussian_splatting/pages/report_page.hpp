// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "run_record.hpp"

namespace gs::pages {

/// The content of the report about a run.
struct report {
    run_record run;
    std::vector<view_images> views;
    bool are_held_out = false;  ///< whether the views are held out from training
};

/// Writes a page about a run: its metrics, typical views, curves, times, effects and settings. The
/// page needs no other files. Only its slider needs JavaScript. Texts are escaped, and paths appear
/// without their folders.
void write_report_page(std::ostream& out, const report& content);

/// Returns the command that repeats a run with the options that its user gave. Scene and output
/// folder have no folders above them.
std::string command_of(const nlohmann::ordered_json& settings);

}  // namespace gs::pages
