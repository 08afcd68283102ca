// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "run_program.hpp"
#include "small_scene.hpp"
#include "small_training.hpp"

using namespace gs_test;

namespace {

/// A deterministic training that takes about a second.
words long_training(const fs::path& output) {
    return words{"train", "-i",       "400", "-o", output.string(),     "--deterministic", "-r",
                 "24",    "--device", "cpu", "-d", "synthetic:spheres", "--eval",          "--quiet"};
}

fs::path checkpoint(const fs::path& output, int iteration) {
    return output / "checkpoints" / ("iteration_" + std::to_string(iteration) + ".safetensors");
}

void wait_for(const fs::path& file) {
    for (int i = 0; i < 3000 && !fs::exists(file); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    REQUIRE(fs::exists(file));
}

/// Runs a training and sends it the signal when it has made the checkpoint.
outcome stopped(const words& arguments, const fs::path& after, int signal) {
    return run_and_then(arguments, [&](pid_t process, const fs::path&) {
        wait_for(after);
        kill(process, signal);
    });
}

}  // namespace

TEST_CASE("checkpoints: a killed training continues, and writes the model of an uninterrupted one") {
    const temporary_folder folder;
    const fs::path whole = folder / "whole", killed = folder / "killed";
    // Both make the same checkpoints, at which the losses of the steps since the last one are summed.
    check_success(long_training(whole) + words{"--checkpoint-every", "30"});
    const words options = long_training(killed) + words{"--checkpoint-every", "30", "--resume"};
    for (const int iteration : {30, 150, 270})
        CHECK(stopped(options, checkpoint(killed, iteration), SIGKILL).code == -1);
    check_success(options);
    CHECK(read_file(model_of(killed, 400)) == read_file(model_of(whole, 400)));
    CHECK(fs::exists(checkpoint(killed, 390)));
    CHECK(fs::exists(checkpoint(killed, 400)));
    CHECK_FALSE(fs::exists(checkpoint(killed, 360)));
    json first = read_json(whole / "metrics.json"), second = read_json(killed / "metrics.json");
    for (const char* name : {"psnr", "training_psnr", "gaussians", "pairs_per_iteration"}) {
        CAPTURE(name);
        CHECK(first.at(name) == second.at(name));
    }
}

TEST_CASE("checkpoints: SIGTERM and SIGINT save the state, and the hint continues the training") {
    const temporary_folder folder;
    const fs::path whole = folder / "whole";
    check_success(long_training(whole));
    for (const auto& [signal, code] : {std::pair(SIGTERM, 143), std::pair(SIGINT, 130)}) {
        const fs::path output = folder / std::to_string(signal);
        const words options = long_training(output) + words{"--checkpoint-iterations", "40"};
        const outcome o = stopped(options, checkpoint(output, 40), signal);
        CHECK(o.code == code);
        CHECK(says(o.err, {"interrupted after iteration", "add --resume"}));
        CHECK(std::ranges::count(o.err, '\n') == 1);
        check_success(long_training(output) + words{"--resume"});
        CHECK(read_file(model_of(output, 400)) == read_file(model_of(whole, 400)));
    }
}

TEST_CASE("checkpoints: an interrupted training is finished early with fewer iterations") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    words options = long_training(output);
    const outcome o =
        stopped(options + words{"--checkpoint-iterations", "40"}, checkpoint(output, 40), SIGTERM);
    const auto at = o.err.find("--iterations ");
    REQUIRE(at != std::string::npos);
    options[2] = std::to_string(std::stoi(o.err.substr(at + 13)));
    check_success(options + words{"--resume"});
    CHECK(fs::exists(model_of(output, std::stoi(options[2]))));
}

TEST_CASE("checkpoints: a replaced run stays until the new one is complete") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    check_success(small_training(output) + words{"-q"});
    const std::string model = read_file(model_of(output, 60));
    const words options = long_training(output) + words{"--checkpoint-iterations", "40"};
    stopped(options + words{"--overwrite"}, checkpoint(output, 40), SIGKILL);
    CHECK(read_file(model_of(output / "replaced", 60)) == model);
    stopped(options + words{"--overwrite"}, checkpoint(output, 40), SIGKILL);
    CHECK(read_file(model_of(output / "replaced", 60)) == model);
    check_success(options + words{"--resume"});
    CHECK_FALSE(fs::exists(output / "replaced"));
    CHECK(fs::exists(model_of(output, 400)));
}

TEST_CASE("checkpoints: an earlier run is continued or replaced only on request") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    check_success(small_training(output) + words{"-q"});
    write_file(output / "notes.txt", "mine");
    const auto before = contents(output);
    check_refusal(small_training(output), {output.string(), "--resume", "--overwrite"});
    check_refusal(small_training(output) + words{"--resume"}, {"without a checkpoint", "--overwrite"});
    check_refusal(small_training(output) + words{"--resume", "--overwrite"}, {"exclude each other"});
    CHECK(contents(output) == before);
    words shorter = small_training(output) + words{"-q", "--overwrite"};
    shorter[2] = "50";
    check_success(shorter);
    CHECK_FALSE(fs::exists(model_of(output, 60)));
    CHECK(fs::exists(model_of(output, 50)));
    CHECK(read_file(output / "notes.txt") == "mine");
    CHECK_FALSE(fs::exists(output / "replaced"));
}

TEST_CASE("checkpoints: --resume begins without a checkpoint, and reports changed options") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    words options = small_training(output) + words{"--resume", "--checkpoint-every", "50"};
    const outcome begun = run(options);
    REQUIRE(begun.code == 0);
    CHECK(says(begun.out, {"no checkpoint in " + output.string()}));
    options[2] = "90";
    const outcome continued = run(options + words{"--seed", "5"});
    REQUIRE(continued.code == 0);
    CHECK(says(continued.out, {"continuing after iteration 60, from " + checkpoint(output, 60).string(),
                               "changed options: ", "iterations 60 to 90", "seed 0 to 5"}));
    CHECK(read_json(output / "metrics.json").at("iterations") == 90);
    CHECK(fs::exists(model_of(output, 90)));
}

TEST_CASE("checkpoints: --keep-checkpoints sets the number of checkpoints that stay") {
    const temporary_folder folder;
    check_success(small_training(folder / "output") +
                  words{"-q", "--checkpoint-every", "10", "--keep-checkpoints", "3"});
    CHECK(contents(folder / "output/checkpoints").size() == 3);
    CHECK(fs::exists(checkpoint(folder / "output", 40)));
}

TEST_CASE("checkpoints: a damaged one is reported, and training continues from the one before it") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    const words options = small_training(output) + words{"--deterministic", "--checkpoint-every", "25"};
    check_success(options + words{"-q"});
    const std::string model = read_file(model_of(output, 60));
    write_file(checkpoint(output, 60), read_file(checkpoint(output, 60)).substr(0, 5000));
    const outcome o = run(options + words{"--resume"});
    REQUIRE(o.code == 0);
    CHECK(says(o.out, {"warning: the checkpoint " + checkpoint(output, 60).string() + " is damaged",
                       "continuing after iteration 50"}));
    CHECK(read_file(model_of(output, 60)) == model);
    for (const int iteration : {50, 60}) write_file(checkpoint(output, iteration), "damaged");
    const auto before = contents(output);
    check_refusal(options + words{"--resume", "-q"}, {"all checkpoints", "--overwrite"});
    CHECK(contents(output) == before);
}

TEST_CASE("checkpoints: a photo that has vanished is named, and the checkpoint stays") {
    const temporary_folder folder;
    const fs::path data = folder / "data", output = folder / "output";
    small_scene().write(data);
    const words options = training(data) + words{"-o", output.string(), "--checkpoint-iterations", "3"};
    check_success(options + words{"-q"});
    const std::string saved = read_file(checkpoint(output, 3));
    fs::remove(data / "images" / small_scene::photo(2));
    check_refusal(options + words{"--resume", "-q"}, {small_scene::photo(2)});
    CHECK(read_file(checkpoint(output, 3)) == saved);
}

TEST_CASE("checkpoints: training continues if one cannot be written") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    // No file can have the name of a folder that is not empty.
    write_file(checkpoint(output, 20).string() + ".part/in_the_way", "");
    const outcome o = run(small_training(output) + words{"--resume", "--checkpoint-iterations", "20", "30"});
    CHECK(o.code == 0);
    CHECK(says(o.out, {"warning: cannot write " + checkpoint(output, 20).string() + ": Is a directory",
                       "training continues"}));
    CHECK(fs::exists(checkpoint(output, 30)));
}

TEST_CASE("checkpoints: a full disk ends training with one sentence, and the earlier checkpoint stays") {
    const temporary_folder folder;
    const fs::path output = folder / "output";
    const words options = small_training(output) + words{"--checkpoint-every", "20"};
    check_success(options + words{"-q"});
    const auto before = contents(output);
    // Files may have at most 100 kB, less than a model or a checkpoint.
    rlimit usual{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
    const rlimit small{100'000, usual.rlim_max};
    std::signal(SIGXFSZ, SIG_IGN);
    REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
    words more = options + words{"--resume"};
    more[2] = "80";
    const outcome o = run(more);
    REQUIRE(setrlimit(RLIMIT_FSIZE, &usual) == 0);
    std::signal(SIGXFSZ, SIG_DFL);
    CHECK(o.code == 2);
    CHECK(o.err == "error: cannot write " + model_of(output, 80).string() + ": File too large\n");
    for (const auto& [name, bytes] : before) {
        CAPTURE(name);
        CHECK(contents(output).at(name) == bytes);
    }
    CHECK(fs::is_empty(model_of(output, 80).parent_path()));
}
