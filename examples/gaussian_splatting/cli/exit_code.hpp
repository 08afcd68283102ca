// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace gs::cli {

/// Thrown to end the program with this code, after another process has printed the reason.
struct reported_failure {
    int code;
};

/// Runs a command. Prints its exception, if it throws one, and returns the exit code of the program:
/// 2 for input that users can correct, 128 plus the number of a signal, otherwise 3.
int exit_code_of(const std::function<void()>& command);

}  // namespace gs::cli
