// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "stage.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "child_process.hpp"

namespace gs::poses {
namespace {

/// Returns whether the line is like "frame=12", by which ffmpeg reports progress.
bool is_key_with_value(const std::string& line) {
    const auto end = std::ranges::find_if(line, [](unsigned char c) { return !std::isalnum(c) && c != '_'; });
    return end != line.end() && *end == '=';
}

bool names_error(const std::string& line) {
    for (const char* word : {"ERROR", "rror:", "Check failed"})
        if (line.find(word) != std::string::npos) return true;
    return false;
}

}  // namespace

stage_runner::stage_runner(const std::filesystem::path& log, const listener& user) : log_(log), user_(user) {
    if (!log_) throw error("cannot write " + log.string());
}

void stage_runner::note(const std::string& line) {
    log_ << line << std::endl;  // a user may follow the file
    const bool is_error = names_error(line);
    const bool has_text = std::ranges::any_of(line, [](unsigned char c) { return std::isalnum(c); });
    if (!has_text || is_key_with_value(line) || (has_error_line_ && !is_error)) return;
    explanation_ = sanitize_for_message(line);
    has_error_line_ = is_error;
}

int stage_runner::run(const stage& one) {
    log_ << "$ " << one.program;
    for (const std::string& argument : one.arguments) log_ << ' ' << argument;
    log_ << std::endl;
    explanation_.clear();
    has_error_line_ = false;
    user_.progress(one.name, 0, one.total);
    return run_child(one.program, one.arguments, [&](const std::string& line) {
        note(line);
        const int done = one.parts_done(line);
        if (done >= 0) user_.progress(one.name, std::min(done, one.total), one.total);
    });
}

void stage_runner::require(const stage& one) {
    const int status = run(one);
    if (status != 0)
        throw error(one.program + " failed at " + one.name + " with exit status " + std::to_string(status) +
                    (explanation_.empty() ? "" : " (" + explanation_ + ")"));
}

std::string stopwatch::text() const {
    char text[40];
    if (const double elapsed = seconds(); elapsed < 60) {
        std::snprintf(text, sizeof text, "%.1f s", elapsed);
    } else {
        const auto whole = static_cast<long>(elapsed);
        std::snprintf(text, sizeof text, "%ld:%02ld min", whole / 60, whole % 60);
    }
    return text;
}

}  // namespace gs::poses
