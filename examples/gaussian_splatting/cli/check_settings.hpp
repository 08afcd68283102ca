// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Sets the members that depend on other options, such as whether to load masks and depth maps.
void set_dependent_values(settings& s);

/// Throws `error` if the option belongs to another densification strategy than `strategy`.
void check_belongs_to_strategy(const options::option& row, const std::string& strategy);

/// Throws `error` if values of options contradict each other.
void check_settings(const settings& s);

}  // namespace gs::cli
