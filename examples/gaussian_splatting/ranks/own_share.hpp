// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "communicator.hpp"

namespace gs::ranks {

/// Returns the threads of this rank, if it shares `threads` with the ranks that pass the same number of
/// their `processors`. Collective.
int own_threads(communicator& all, int threads, std::uint64_t processors);

/// Returns the first rank that has no device, or that of a rank before it. Returns the number of ranks if
/// each has one for itself. `device` is a number of this rank's device, or 0 for none. Collective.
int first_without_device(communicator& all, std::uint64_t device);

}  // namespace gs::ranks
