// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "../checkpoint/checkpoint_folder.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns the checkpoints of the run in an output folder.
checkpoint_folder checkpoints_in(const std::filesystem::path& output);

/// Throws `error` if the output folder holds an earlier run and the options do not tell what to do
/// with it.
void require_no_earlier_run(const settings& s);

/// Moves the models, renders, metrics and checkpoints of an earlier run to the folder `replaced` in the
/// output folder. Other files stay. If an earlier call was interrupted, keeps the results that it moved.
void set_aside_earlier_run(const std::filesystem::path& output);

/// Removes the results that `set_aside_earlier_run` moved.
void remove_replaced_run(const std::filesystem::path& output);

/// Returns the checkpoint that --resume continues from, or nothing if training has to begin. Throws
/// `error` if a finished run has no checkpoint.
std::optional<checkpoint_folder::found_checkpoint> checkpoint_to_resume(const settings& s,
                                                                        const log_function& warn);

/// Returns the options that differ between two settings.json, for a message, such as "iterations 7000
/// to 9000". Ignores options that neither run was given, and those that do not affect the model.
std::string changed_options(const nlohmann::ordered_json& before, const nlohmann::ordered_json& now);

}  // namespace gs::cli
