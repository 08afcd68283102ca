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

constexpr const char* checkpoints_name = "checkpoints";
/// The results of training that belong to one run.
constexpr std::array result_names{"point_cloud", "test",       "settings.json",  "metrics.json",
                                  "metrics.csv", "metrics.md", "exposures.json", checkpoints_name};

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

void remove_earlier_run(const fs::path& output) {
    for (const char* name : result_names) fs::remove_all(output / name);
}

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
    constexpr std::array ignored{given_options_key, "output", "save_iterations", "checkpoint_iterations"};
    std::string changes;
    for (const auto& [name, value] : now.items()) {
        const auto old = before.find(name);
        if (old == before.end() || *old == value || std::ranges::find(ignored, name) != ignored.end())
            continue;
        changes += (changes.empty() ? "" : ", ") + name + " " + old->dump() + " to " + value.dump();
    }
    return changes;
}

}  // namespace gs::cli
