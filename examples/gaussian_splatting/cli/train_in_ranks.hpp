// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "settings.hpp"

namespace gs::cli {

/// Trains in `settings::ranks` processes, which share the threads of this one. Throws
/// `std::runtime_error` with a sentence that names the rank if one of them fails or is killed.
/// Precondition: this process has no other threads, and has not used OpenMP.
void train_in_ranks(const settings& s);

}  // namespace gs::cli
