// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "../communicator.hpp"

namespace gs::ranks {

/// Returns the name of the MPI library, or nothing if this program was built without MPI.
std::string mpi_library();

/// Calls `body` in this process, as one of the ranks that mpirun or srun has started, and ends the
/// process with the exit code of rank 0. Rank 0 reports its own errors. If another rank fails, and not
/// all do, that rank calls `report` with a sentence that names it. The others then end within
/// seconds, also if they are not in a collective function.
///
/// Throws `error` if this program was built without MPI, or if MPI finds other processes than the
/// launcher started.
/// Precondition: this process has not called it before.
void run_with_mpi(const std::function<int(communicator&)>& body,
                  const std::function<void(const std::string&)>& report);

}  // namespace gs::ranks
