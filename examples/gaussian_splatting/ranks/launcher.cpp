// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "launcher.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace gs::ranks {

namespace {

int number_in_environment(const char* name) {
    const char* const text = std::getenv(name);
    return text == nullptr ? 0 : std::atoi(text);
}

}  // namespace

launch launch_in_environment() {
    struct names {
        const char *number, *count;
    };
    // Slurm sets SLURM_NTASKS in batch scripts, too, but the size of a step only in the step.
    for (const auto& [number, count] :
         {names{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, names{"PMI_RANK", "PMI_SIZE"},
          names{"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}})
        if (number_in_environment(count) > 1)
            return {number_in_environment(number), number_in_environment(count)};
    return {};
}

bool is_slurm_without_pmi() {
    constexpr std::array connected{"PMIX_RANK", "PMI_RANK", "OMPI_COMM_WORLD_RANK"};
    return number_in_environment("SLURM_STEP_NUM_TASKS") > 1 &&
           std::ranges::none_of(connected, [](const char* name) { return std::getenv(name) != nullptr; });
}

bool is_started_by_launcher() {
    std::string parent;
    std::getline(std::ifstream("/proc/" + std::to_string(getppid()) + "/comm"), parent);
    constexpr std::array<std::string_view, 6> launchers{"mpirun", "mpiexec", "orte",
                                                        "prte",   "hydra",   "slurmstepd"};
    return std::ranges::any_of(launchers, [&](std::string_view name) { return parent.starts_with(name); });
}

}  // namespace gs::ranks
