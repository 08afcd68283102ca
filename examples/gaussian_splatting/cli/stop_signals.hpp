// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace gs::cli {

/// While an object exists, the first SIGINT (Ctrl-C), SIGTERM or SIGHUP (a closed terminal) does not
/// end the process, but is recorded. A second one ends it. At most one object may exist.
class stop_signals {
  public:
    stop_signals();
    stop_signals(const stop_signals&) = delete;
    stop_signals& operator=(const stop_signals&) = delete;
    ~stop_signals();

    /// Returns the number of the recorded signal, or 0.
    int received() const;
};

/// Ends the program after a signal, with what is worth keeping saved. The exit code is 128 plus the signal's
/// number.
struct interruption : std::runtime_error {
    interruption(int number, const std::string& message) : std::runtime_error(message), signal(number) {}
    int signal;
};

}  // namespace gs::cli
