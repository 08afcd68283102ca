// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "option_table.hpp"

namespace gs::cli {

/// Sets the options of `preset` in `table`, but no option that `is_explicit` (given its name), nor one that
/// such an option excludes.
void apply_quality_preset(quality_preset preset, const std::vector<option>& table,
                          const std::function<bool(const std::string& name)>& is_explicit);

/// The options of a preset as one would type them; empty for the defaults.
std::string options_of(quality_preset preset);

}  // namespace gs::cli
