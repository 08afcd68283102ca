// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

/// The option that names a file with further options.
inline constexpr const char* config_option = "--config";

using options::option;
using options::option_value;

/// Returns the table of all options. Their values are the members of `s`, which must outlive the
/// table.
std::vector<option> option_table(settings& s);

/// Returns the options of a command in the order of the table.
std::vector<option> rows_of(command c, const std::vector<option>& table);

/// Returns the purpose of a command, as a phrase that begins with a verb.
std::string purpose_of(command c);

}  // namespace gs::cli
