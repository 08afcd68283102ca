// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "option_table.hpp"

namespace gs::cli {

/// Sets the options of `preset` in `table`. Keeps options for whose names `is_explicit` is true,
/// and options that such an option excludes.
void apply_quality_preset(quality_preset preset, const std::vector<option>& table,
                          const std::function<bool(const std::string& name)>& is_explicit);

/// Returns the options of a preset as users type them. The text is empty for the defaults.
std::string options_of(quality_preset preset);

}  // namespace gs::cli
