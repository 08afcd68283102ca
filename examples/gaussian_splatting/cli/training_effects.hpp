// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "../training/training.hpp"
#include "command_context.hpp"

namespace gs::cli {

/// Decides which effects training simulates, and prints the reasons. Throws `error` if an effect
/// contradicts --background.
features::feature_set resolve_effects(const settings& s, const scene& scene, const command_context& context);

/// Returns the effects in use, as users type them after --effects.
std::string effects_in_use(const features::feature_set& features);

/// Returns, for each effect, whether it was on, the reason, and what training reports about it.
nlohmann::ordered_json effects_json(const settings& s, const scene& scene,
                                    const train::train_options& options, const train::train_result& result);

}  // namespace gs::cli
