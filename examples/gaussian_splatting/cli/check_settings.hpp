// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Sets the members that follow from options of other names.
void set_dependent_values(settings& s);

/// Throws `error` for an option of another densification strategy than `strategy`.
void check_belongs_to_strategy(const options::option& row, const std::string& strategy);

/// Throws `error` for options whose values contradict each other.
void check_settings(const settings& s);

}  // namespace gs::cli
