// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gs::cli {

/// Returns the script with which a shell completes the program's command line. `shell`: bash or
/// zsh. Throws `error` for other shells.
std::string completion_script(const std::string& shell);

}  // namespace gs::cli
