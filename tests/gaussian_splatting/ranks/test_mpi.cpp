// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>

#include "../cli/run_program.hpp"
#include "../cli/small_scene.hpp"
#include "poses/child_process.hpp"
#include "rank_processes.hpp"
#include "ranks/mpi/mpi.hpp"

using namespace gs_test;

namespace {

bool can_use_mpi() {
    const bool can = !gs::ranks::mpi_library().empty() && gs::poses::is_installed("mpirun");
    if (!can) MESSAGE("skipped: this program was built without MPI, or mpirun is not installed");
    return can;
}

/// Starts the words that follow in several processes. Containers run as root, with few cores.
words mpirun(int processes) {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);
    return {"mpirun", "--quiet", "--oversubscribe", "-n", std::to_string(processes)};
}

outcome run_with(const words& launcher, const words& arguments) {
    return run_and_then(
        arguments, [](pid_t, const fs::path&) {}, "1", launcher);
}

void check_success_with(const words& launcher, const words& arguments) {
    const outcome o = run_with(launcher, arguments);
    CHECK(o.err == "");
    REQUIRE(o.code == 0);
}

const words spheres{
    "train", "-d", "synthetic:spheres,views=8", "-r", "32", "--quiet", "--device", "cpu", "--deterministic"};

/// A training that densifies, with views of three tile rows.
words densifying_run(const fs::path& output) {
    return {"train",
            "-d",
            "synthetic:spheres,views=8",
            "-o",
            output,
            "-r",
            "48",
            "-i",
            "40",
            "--quiet",
            "--device",
            "cpu",
            "--deterministic",
            "--eval",
            "--effects",
            "auto,+direction",
            "--densify-from-iter",
            "10",
            "--densify-until-iter",
            "35",
            "--densification-interval",
            "10"};
}

words small_run(const fs::path& output) { return spheres + words{"-o", output, "-i", "200"}; }

fs::path checkpoint(const fs::path& output, int iteration) {
    return output / "checkpoints" / ("iteration_" + std::to_string(iteration) + ".safetensors");
}

/// Runs a long training with checkpoints in two processes, and sends a signal to the second one.
outcome interrupt_second_rank(const fs::path& output, int number) {
    std::chrono::steady_clock::time_point from;
    const outcome o = run_and_then(
        small_run(output) + words{"--mpi", "--checkpoint-every", "20"},
        [&](pid_t process, const fs::path&) {
            wait_for(checkpoint(output, 40));
            const auto ranks = children_of(process);
            REQUIRE(ranks.size() == 3);
            from = std::chrono::steady_clock::now();
            kill(ranks[1], number);
        },
        "1", mpirun(3));
    CHECK(std::chrono::steady_clock::now() - from < std::chrono::seconds(15));
    return o;
}

}  // namespace

TEST_CASE("mpi: processes of mpirun write the same model as one process and as --ranks") {
    if (!can_use_mpi()) return;
    const temporary_folder folder;
    check_success(densifying_run(folder / "1"), "1");
    check_success(densifying_run(folder / "forked") + words{"--ranks", "3"}, "3");
    check_success_with(mpirun(2), densifying_run(folder / "2") + words{"--mpi"});
    check_success_with(mpirun(3), densifying_run(folder / "3") + words{"--mpi"});
    const auto metrics = [&](const char* name) { return read_json(folder / name / "metrics.json"); };
    for (const char* name : {"forked", "2", "3"}) {
        CAPTURE(name);
        CHECK(read_file(model_of(folder / name, 40)) == read_file(model_of(folder / "1", 40)));
        CHECK(metrics(name).at("psnr") == metrics("1").at("psnr"));
        CHECK(contents(folder / name).size() == contents(folder / "1").size());
    }
    CHECK(metrics("1").at("gaussians") > 3000);
    CHECK(metrics("3").at("exchange") == metrics("forked").at("exchange"));
}

TEST_CASE("mpi: a killed rank ends the others, and another number of ranks continues") {
    if (!can_use_mpi()) return;
    const temporary_folder folder;
    const fs::path killed = folder / "killed", whole = folder / "whole";
    check_success(small_run(whole), "1");
    CHECK(interrupt_second_rank(killed, SIGKILL).code != 0);
    CHECK(!fs::exists(model_of(killed, 200)));
    check_success_with(mpirun(2), small_run(killed) + words{"--mpi", "--resume"});
    CHECK(read_file(model_of(killed, 200)) == read_file(model_of(whole, 200)));
}

TEST_CASE("mpi: a signal to any rank saves the state") {
    if (!can_use_mpi()) return;
    const temporary_folder folder;
    const outcome o = interrupt_second_rank(folder / "out", SIGTERM);
    CHECK(o.code == 130);
    CHECK(std::ranges::count(o.err, '\n') == 1);
    CHECK(says(o.err, {"interrupted after iteration", "add --resume"}));
}

TEST_CASE("mpi: an error that all ranks find is reported once, and leaves nothing behind") {
    if (!can_use_mpi()) return;
    const temporary_folder folder;
    const outcome o = run_with(
        mpirun(2), {"train", "-d", "no scene", "-o", (folder / "new").string(), "--device", "cpu", "--mpi"});
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.err.starts_with("error: no scene"));
    CHECK(std::ranges::count(o.err, '\n') == 1);
    CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("mpi: a rank that fails alone is named, and ends the others") {
    if (!can_use_mpi()) return;
    const temporary_folder folder;
    const fs::path launcher = folder / "start";
    write_file(launcher, "#!/bin/sh\n[ $OMPI_COMM_WORLD_RANK = 1 ] && cd /\nexec \"$@\"\n");
    fs::permissions(launcher, fs::perms::owner_all);
    gs_test::small_scene{}.write(folder / "scene");
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    const outcome o =
        run_with(mpirun(3) + words{launcher.string()},
                 training("scene") + words{"-o", (folder / "out").string(), "--mpi", "--quiet"});
    fs::current_path(before);
    CAPTURE(o.err);
    CHECK(o.code == 3);
    CHECK(says(o.err, {"error: rank 1 of 3 has failed: scene does not exist"}));
    CHECK(std::ranges::count(o.err, '\n') == 1);
}

TEST_CASE("mpi: processes that a script starts alone may train alone") {
    const temporary_folder folder;
    setenv("SLURM_STEP_NUM_TASKS", "4", 1);
    setenv("SLURM_PROCID", "2", 1);
    check_success(spheres + words{"-i", "5", "-o", (folder / "alone").string()}, "1");
    // The name of a launcher, which Linux takes from the script.
    write_file(folder / "slurmstepd", "#!/bin/sh\n\"$@\"\n");
    fs::permissions(folder / "slurmstepd", fs::perms::owner_all);
    const words launcher{(folder / "slurmstepd").string()};
    const words train = spheres + words{"-i", "5", "-o", (folder / "same").string()};
    for (const words& wrong : {words{}, words{"--mpi", "--ranks", "2"}}) {
        const outcome other = run_with(launcher, train + wrong);
        CHECK(other.code == 2);
        CHECK(other.err == "");
    }
    setenv("SLURM_PROCID", "0", 1);
    const outcome first = run_with(launcher, train);
    unsetenv("SLURM_PROCID");
    unsetenv("SLURM_STEP_NUM_TASKS");
    CHECK(first.code == 2);
    CHECK(says(first.err, {"error: ", "one of 4 processes", "add --mpi"}));
    // A batch script has these variables of its job, but no step.
    setenv("SLURM_NTASKS", "4", 1);
    setenv("SLURM_PROCID", "0", 1);
    check_success_with(launcher, train);
    unsetenv("SLURM_NTASKS");
    unsetenv("SLURM_PROCID");
}

TEST_CASE("mpi: srun must start processes with PMIx") {
    const temporary_folder folder;
    const words train = spheres + words{"-i", "5", "-o", (folder / "out").string(), "--mpi"};
    for (const char* name : {"PMIX_RANK", "PMI_RANK", "OMPI_COMM_WORLD_RANK"}) unsetenv(name);
    setenv("SLURM_STEP_NUM_TASKS", "2", 1);
    setenv("SLURM_PROCID", "0", 1);
    const outcome first = run_with({}, train);
    setenv("SLURM_PROCID", "1", 1);
    const outcome second = run_with({}, train);
    unsetenv("SLURM_PROCID");
    unsetenv("SLURM_STEP_NUM_TASKS");
    CHECK(first.code == 2);
    CHECK(says(first.err, {"error: ", "srun", "add --mpi=pmix"}));
    CHECK(std::ranges::count(first.err, '\n') == 1);
    CHECK(second.code == 2);
    CHECK(second.err == "");
}

TEST_CASE("mpi: contradictory options are refused") {
    const words train{"train", "-d", "synthetic:spheres", "--mpi"};
    check_refusal_without_trace(train + words{"--ranks", "2"}, {"--mpi", "leave out --ranks"});
    check_refusal_without_trace(train + words{"--gpus", "2"}, {"--mpi", "leave out --gpus"});
    check_refusal_without_trace(train + words{"--viewer", "8080"}, {"--mpi", "--viewer"});
    check_refusal_without_trace(train + words{"--poses", "auto"}, {"--mpi", "--poses auto"});
    if (gs::ranks::mpi_library().empty())
        check_refusal_without_trace(train, {"--mpi", "without MPI", "libopenmpi-dev"});
}
