// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "option_table.hpp"

namespace gs::cli {

/// The --help without a command.
std::string overview();

/// The --help of a command. `rows`: its options, whose members still hold their defaults.
std::string help_text(command c, const std::vector<option>& rows);

/// The text of docs/reference/cli.md.
std::string reference_page();

/// The manual page, in the format of man.
std::string man_page();

}  // namespace gs::cli
