// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "option_table.hpp"

namespace gs::cli {

/// An option that the program takes instead of a command.
struct program_option {
    std::string name, help;
    std::string type = "";  ///< placeholder of its value, such as "SHELL"; empty if it has none
};
const std::vector<program_option>& program_options();

/// Returns the text of --help without a command.
std::string overview();

/// Returns the text of --help for a command. `rows`: the options of the command. Precondition:
/// their members have the default values.
std::string help_text(command c, const std::vector<option>& rows);

/// Returns the text of docs/reference/cli.md.
std::string reference_page();

/// Returns the manual page, in the format of man.
std::string man_page();

}  // namespace gs::cli
