// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs::ranks {

/// The processes that a launcher, such as mpirun or srun, has started together with this one.
struct launch {
    int number = 0;  ///< of this process, from 0
    int count = 1;
};

/// Returns what the launcher wrote to the environment. Programs that it started inherit these values,
/// even if they run alone.
launch launch_in_environment();

/// Returns whether Slurm has started several processes without PMIx or PMI, of which MPI needs one to connect
/// them.
bool is_slurm_without_pmi();

/// Returns whether the launcher itself has started this process, and not a script in between.
bool is_started_by_launcher();

}  // namespace gs::ranks
