// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "../training/training.hpp"
#include "command_context.hpp"

namespace gs::cli {

/// Chooses the effects that training simulates and prints why. Throws `error` if one of them contradicts
/// --background.
features::feature_set resolve_effects(const settings& s, const scene& scene, const command_context& context);

/// The effects in use, as one would give them to --effects.
std::string effects_in_use(const features::feature_set& features);

/// Each effect: whether it was in use, why, and what training made of it.
nlohmann::ordered_json effects_json(const settings& s, const scene& scene,
                                    const train::train_options& options, const train::train_result& result);

}  // namespace gs::cli
