// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "communicator.hpp"

namespace gs::ranks {

/// How the processes of a training have ended.
struct outcome {
    int code = 0;        ///< exit code of rank 0
    std::string reason;  ///< a sentence that names the rank that made the others end, or empty
    int signal = 0;      ///< the signal for this process that ended rank 0, or 0
};

/// Forks `count` processes, the ranks, and waits for all of them. Each one calls `body`, and exits
/// with the code that it returns. Rank 0 reports its own errors; an exception of another rank
/// becomes the `reason`.
///
/// If a rank fails or is killed, the others get `peer_ended` from their next collective function,
/// and are killed if they still run some seconds later. SIGINT, SIGTERM and SIGHUP are passed on to
/// rank 0. If this process is killed, all ranks are.
///
/// Precondition: this process has no other threads, and has not used OpenMP.
outcome run(int count, const std::function<int(communicator&)>& body);

}  // namespace gs::ranks
