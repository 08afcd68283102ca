// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../options/option.hpp"
#include "settings.hpp"

namespace gs::cli {

using options::option;
using options::option_value;

/// The table of all options. Their values are the members of `s`, which has to outlive the table.
std::vector<option> option_table(settings& s);

/// What a command is for, as a phrase that begins with a verb.
std::string purpose_of(command c);

}  // namespace gs::cli
