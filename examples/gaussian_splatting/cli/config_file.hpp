// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "option_table.hpp"

namespace gs::cli {

/// Returns the words that a JSON file gives for the options in `rows`, by `option::name`. The file is
/// an object with one member per option, as in settings.json, or a settings.json, whose member
/// `given` is such an object. Options that are null or switched off are left out. Throws `error`
/// if the file cannot be read, or has an unknown option or a value that no option can have.
std::map<std::string, std::vector<std::string>> read_config(const std::string& file,
                                                            const std::vector<option>& rows);

/// The member of settings.json that has the options which the user gave.
inline constexpr const char* given_options_key = "given";

}  // namespace gs::cli
