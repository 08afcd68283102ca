// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "settings.hpp"

namespace gs::cli {

/// Reads and checks the words that follow the program's name. Prints a text and exits for --help,
/// --version, and the options that begin with --print. Throws `error` with one sentence that names
/// the option, its value and the remedy.
settings parse(std::vector<std::string> words);

}  // namespace gs::cli
