// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../../core/error.hpp"
#include "mpi.hpp"

namespace gs::ranks {

std::string mpi_library() { return ""; }

void run_with_mpi(const std::function<int(communicator&)>&, const std::function<void(const std::string&)>&) {
    throw error("--mpi: this program was built without MPI: install libopenmpi-dev and build it again");
}

}  // namespace gs::ranks
