// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "train_in_ranks.hpp"

#include <omp.h>

#include <algorithm>
#include <csignal>
#include <stdexcept>

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

void train_as_rank(settings s, ranks::communicator& all, int threads) {
    if (!all.is_first()) s.log_level = log_level::error;
    if (s.device == device_kind::automatic)
        command_context(s).say("using the CPU, because --ranks trains on the CPU only");
    omp_set_num_threads(share_of(threads, all));
    train(s, train::make_cpu_engine(), s.deterministic ? accumulator::fixed : accumulator::native, all);
}

}  // namespace

void train_in_ranks(const settings& s) {
    const int threads = omp_get_max_threads();
    const ranks::outcome end = ranks::run(s.ranks, [&](ranks::communicator& all) {
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
