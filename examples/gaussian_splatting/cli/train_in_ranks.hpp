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

/// Trains together with the processes that mpirun or srun has started, and ends this process. Each one
/// takes a GPU, or all share the threads of their machines. Throws `error` if this program has no MPI.
/// Precondition: as above.
void train_with_mpi(const settings& s);

/// Throws `error` if mpirun or srun has started this process and others alike.
void require_single_process();

/// Ends this process, if it is not the first one that mpirun or srun has started, and leaves the first
/// one the time to report an error that all of them find before they are connected.
void leave_error_to_first_process();

}  // namespace gs::cli
