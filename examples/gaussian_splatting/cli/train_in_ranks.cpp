// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "train_in_ranks.hpp"

#include <omp.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../core/error.hpp"
#include "../ranks/run.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "exit_code.hpp"

namespace gs::cli {

namespace {

/// Returns the share of `threads` threads that a rank gets.
int share_of(int threads, const ranks::communicator& all) {
    const int more = all.rank() < threads % all.count() ? 1 : 0;
    return std::max(1, threads / all.count() + more);
}

/// Returns the number of GPUs. Asks in another process, because a process that has used CUDA cannot
/// start the ranks.
int gpus_of_this_machine() {
    return ranks::run(1, [](ranks::communicator&) { return train::count_gpus(); }).code;
}

int gpus_for(const settings& s) {
    const int present = gpus_of_this_machine();
    if (present == 0 || s.gpus > present)
        throw error("--gpus " + (s.gpus == 0 ? "all" : std::to_string(s.gpus)) + ": " +
                    (present == 0 ? "no GPU can be used; see gaussian_splatting doctor"
                                  : "this machine has " + std::to_string(present) +
                                        (present == 1 ? " GPU" : " GPUs") + ": give fewer"));
    return s.gpus == 0 ? present : s.gpus;
}

/// Leaves this process the GPU of its rank only.
void choose_gpu(int rank) {
    const char* const visible = std::getenv("CUDA_VISIBLE_DEVICES");
    std::string gpu = std::to_string(rank);
    if (visible != nullptr) {
        std::istringstream names(visible);
        for (int i = 0; i <= rank; ++i) std::getline(names, gpu, ',');
    }
    setenv("CUDA_VISIBLE_DEVICES", gpu.c_str(), 1);
}

void train_as_rank(settings s, ranks::communicator& all, int threads) {
    if (!all.is_first()) s.log_level = log_level::error;
    const auto how = s.deterministic ? accumulator::fixed : accumulator::native;
    omp_set_num_threads(share_of(threads, all));
    if (s.gpus != 1) {
        choose_gpu(all.rank());
        s.device = device_kind::cuda;
        return train(s, command_context(s).make_engine(), how, all);
    }
    if (s.device == device_kind::automatic)
        command_context(s).say("using the CPU, because --ranks trains on the CPU only");
    train(s, train::make_cpu_engine(), how, all);
}

}  // namespace

void train_in_ranks(const settings& s) {
    const int threads = omp_get_max_threads();
    const int count = s.gpus == 1 ? s.ranks : gpus_for(s);
    const ranks::outcome end = ranks::run(count, [&](ranks::communicator& all) {
        if (all.is_first()) return exit_code_of([&] { train_as_rank(s, all, threads); });
        train_as_rank(s, all, threads);
        return 0;
    });
    if (end.signal != 0) std::raise(end.signal);
    if (!end.reason.empty())
        throw std::runtime_error(end.reason +
                                 ", and training needs all ranks; to continue from the last checkpoint, add "
                                 "--resume to the same options");
    if (end.code != 0) throw reported_failure{end.code};
}

}  // namespace gs::cli
