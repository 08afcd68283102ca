// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "settings.hpp"

namespace gs::cli {

/// Trains in `settings::ranks` processes, or in one process for each of `settings::gpus`. They share
/// the threads of this one. Throws `error` if there are fewer GPUs, and `std::runtime_error` with a
/// sentence that names the rank if one of them fails or is killed.
/// Precondition: this process has no other threads, and has used neither OpenMP nor CUDA.
void train_in_ranks(const settings& s);

}  // namespace gs::cli
