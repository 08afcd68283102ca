// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "train_in_ranks.hpp"

#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "../core/error.hpp"
#include "../ranks/launcher.hpp"
#include "../ranks/mpi/mpi.hpp"
#include "../ranks/own_share.hpp"
#include "../ranks/run.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "exit_code.hpp"

namespace gs::cli {

namespace {

/// Returns the number of GPUs. Asks in another process, because a process that has used CUDA can
/// neither start the ranks nor choose one of its GPUs.
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

/// Leaves this process one of its GPUs only.
void choose_gpu(int number) {
    const char* const visible = std::getenv("CUDA_VISIBLE_DEVICES");
    std::string gpu = std::to_string(number);
    if (visible != nullptr) {
        std::istringstream names(visible);
        for (int i = 0; i <= number; ++i) std::getline(names, gpu, ',');
    }
    setenv("CUDA_VISIBLE_DEVICES", gpu.c_str(), 1);
}

void train_as_rank(const settings& s, std::unique_ptr<train::engine> engine, ranks::communicator& all) {
    train(s, std::move(engine), s.deterministic ? accumulator::fixed : accumulator::native, all);
}

void train_as_forked_rank(settings s, ranks::communicator& all, int threads) {
    if (!all.is_first()) s.log_level = log_level::error;
    omp_set_num_threads(ranks::own_threads(all, threads, 0));
    if (s.gpus != 1) {
        choose_gpu(all.rank());
        s.device = device_kind::cuda;
        return train_as_rank(s, command_context(s).make_engine(), all);
    }
    if (s.device == device_kind::automatic)
        command_context(s).say("using the CPU, because --ranks trains on the CPU only");
    train_as_rank(s, train::make_cpu_engine(), all);
}

/// Returns a number for something of a machine, which other things of all machines do not share.
std::uint64_t number_for(const ranks::place& place, std::string_view what) {
    return std::hash<std::string>{}(std::to_string(place.machine) + " " + std::string(what));
}

/// Returns a number that processes share if they may run on the same processors.
std::uint64_t own_processors(const ranks::place& place) {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    sched_getaffinity(0, sizeof(processors), &processors);
    return number_for(place, {reinterpret_cast<const char*>(&processors), sizeof(processors)});
}

/// Chooses one of this process' GPUs. Returns a number for it, or 0 if it cannot be used.
std::uint64_t choose_own_gpu(const ranks::place& place, int gpus) {
    if (gpus == 0) return 0;
    choose_gpu(place.rank_on_machine % gpus);
    std::string reason;
    if (!train::cuda_is_available(reason)) return 0;
    return number_for(place, train::bus_id_of_gpu());
}

/// All ranks decide alike.
std::unique_ptr<train::engine> make_engine(settings& s, ranks::communicator& all, int gpus) {
    if (s.device == device_kind::cpu) return train::make_cpu_engine();
    const int without = ranks::first_without_device(all, choose_own_gpu(all.place(), gpus));
    if (without < all.count()) {
        const std::string who = "rank " + std::to_string(without) + " has no GPU for itself";
        if (s.device == device_kind::cuda)
            throw error("--device cuda: " + who +
                        ": start at most as many processes on a machine as it has GPUs, or see "
                        "gaussian_splatting doctor");
        command_context(s).say("using the CPU: " + who);
        return train::make_cpu_engine();
    }
    s.device = device_kind::cuda;
    return command_context(s).make_engine();
}

void train_as_mpi_rank(settings s, ranks::communicator& all, int gpus) {
    if (!all.is_first()) s.log_level = log_level::error;
    // All ranks call this. Launchers may pass the variable to some machines only.
    const int threads = ranks::own_threads(all, omp_get_max_threads(), own_processors(all.place()));
    if (std::getenv("OMP_NUM_THREADS") == nullptr) omp_set_num_threads(threads);
    auto engine = make_engine(s, all, gpus);
    train_as_rank(s, std::move(engine), all);
}

const std::string advice =
    ", and training needs all ranks; to continue from the last checkpoint, add --resume to the same options";

/// Calls `body`, whose exceptions only the first rank prints here.
int code_of_rank(const ranks::communicator& all, const std::function<void()>& body) {
    if (all.is_first()) return exit_code_of(body);
    body();
    return 0;
}

}  // namespace

void train_in_ranks(const settings& s) {
    const int threads = omp_get_max_threads();
    const int count = s.gpus == 1 ? s.ranks : gpus_for(s);
    const ranks::outcome end = ranks::run(count, [&](ranks::communicator& all) {
        return code_of_rank(all, [&] { train_as_forked_rank(s, all, threads); });
    });
    if (end.signal != 0) std::raise(end.signal);
    if (!end.reason.empty()) throw std::runtime_error(end.reason + advice);
    if (end.code != 0) throw reported_failure{end.code};
}

void train_with_mpi(const settings& s) {
    if (ranks::is_slurm_without_pmi()) {  // MPI would end the processes with a page of text
        leave_error_to_first_process();
        throw error(
            "--mpi: srun has not started these processes with PMIx: add --mpi=pmix to srun's options");
    }
    const int gpus = s.device == device_kind::cpu ? 0 : gpus_of_this_machine();
    ranks::run_with_mpi(
        [&](ranks::communicator& all) { return code_of_rank(all, [&] { train_as_mpi_rank(s, all, gpus); }); },
        [](const std::string& reason) { exit_code_of([&] { throw std::runtime_error(reason + advice); }); });
}

void require_single_process() {
    const ranks::launch launch = ranks::launch_in_environment();
    if (launch.count == 1 || !ranks::is_started_by_launcher()) return;
    leave_error_to_first_process();
    throw error("this is one of " + std::to_string(launch.count) +
                " processes, which would all write the same output: add --mpi to train one model together");
}

void leave_error_to_first_process() {
    if (ranks::launch_in_environment().number == 0) return;
    usleep(500'000);  // mpirun ends all processes when one has failed
    constexpr int code_of_error = 2;
    throw reported_failure{code_of_error};
}

}  // namespace gs::cli
