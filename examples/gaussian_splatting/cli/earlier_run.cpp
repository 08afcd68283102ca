// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "earlier_run.hpp"

#include <algorithm>
#include <array>

#include "../core/error.hpp"
#include "config_file.hpp"

namespace gs::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char *checkpoints_name = "checkpoints", *replaced_name = "replaced";
/// The results of training that belong to one run.
constexpr std::array result_names{"point_cloud", "test",        "settings.json",   "metrics.json",
                                  "metrics.csv", "metrics.md",  "exposures.json",  "poses.json",
                                  "cameras",     "motion.json", "vignetting.json", "response.json",
                                  "viewer.html", "report.html", checkpoints_name};

bool is_finished(const fs::path& output) { return fs::exists(output / "metrics.json"); }

}  // namespace

checkpoint_folder checkpoints_in(const fs::path& output) {
    return checkpoint_folder(output / checkpoints_name);
}

void require_no_earlier_run(const settings& s) {
    const fs::path output = s.output;
    const bool has_run =
        std::ranges::any_of(result_names, [&](const char* name) { return fs::exists(output / name); });
    if (has_run && !s.resume && !s.overwrite)
        throw error(
            "the folder " + s.output +
            " holds an earlier run: give --resume to continue it, --overwrite to replace it, or another "
            "--output");
}

void set_aside_earlier_run(const fs::path& output) {
    const fs::path replaced = output / replaced_name;
    const bool was_interrupted = fs::exists(replaced);
    fs::create_directory(replaced);
    for (const char* name : result_names) {
        if (!fs::exists(output / name)) continue;
        if (was_interrupted) {
            fs::remove_all(output / name);
        } else {
            fs::rename(output / name, replaced / name);
        }
    }
}

void remove_replaced_run(const fs::path& output) { fs::remove_all(output / replaced_name); }

std::optional<checkpoint_folder::found_checkpoint> checkpoint_to_resume(const settings& s,
                                                                        const log_function& warn) {
    if (!s.resume) return {};
    auto found = checkpoints_in(s.output).newest(warn);
    if (!found && is_finished(s.output))
        throw error("the folder " + s.output +
                    " holds a finished run without a checkpoint: give --overwrite to train again");
    return found;
}

std::string changed_options(const nlohmann::ordered_json& before, const nlohmann::ordered_json& now) {
    constexpr std::array ignored{
        "output",           "save_iterations", "save_cameras",     "checkpoint_iterations",
        "checkpoint_every", "log_level",       "keep_checkpoints", "device"};
    const auto is_given = [](const nlohmann::ordered_json& all, const std::string& name) {
        const auto given = all.find(given_options_key);
        return given != all.end() && given->contains(name);
    };
    std::string changes;
    for (const auto& [name, value] : now.items()) {
        const auto old = before.find(name);
        if (old == before.end() || *old == value || std::ranges::find(ignored, name) != ignored.end() ||
            (!is_given(before, name) && !is_given(now, name)))
            continue;
        changes += (changes.empty() ? "" : ", ") + name + " " + old->dump() + " to " + value.dump();
    }
    return changes;
}

}  // namespace gs::cli
