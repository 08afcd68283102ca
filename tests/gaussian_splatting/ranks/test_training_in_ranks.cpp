// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>

#include "../cli/run_program.hpp"
#include "rank_processes.hpp"

using namespace gs_test;

namespace {

/// A deterministic training. Its views have three tile rows, so that a fourth rank has none.
words short_training(const std::string& scene, const fs::path& output, int ranks, int width = 48) {
    return words{"train",
                 "-d",
                 scene,
                 "-o",
                 output.string(),
                 "-r",
                 std::to_string(width),
                 "--device",
                 "cpu",
                 "--quiet",
                 "--deterministic",
                 "--ranks",
                 std::to_string(ranks)};
}

/// Adds Gaussians, removes some of them, and resets opacities.
const words density_control{"-i",
                            "60",
                            "--densify-from-iter",
                            "10",
                            "--densification-interval",
                            "10",
                            "--opacity-reset-interval",
                            "25",
                            "--densify-until-iter",
                            "45"};

/// The model after the last iteration.
std::string final_model(const fs::path& output) {
    return read_file(model_of(output, read_json(output / "metrics.json").at("iterations")));
}

/// Returns the metrics of one rank.
nlohmann::json check_equal_models(const std::string& scene, const words& options, int width = 48) {
    CAPTURE(scene);
    const temporary_folder folder;
    const auto output = [&](int ranks) { return folder / std::to_string(ranks); };
    for (int ranks = 1; ranks <= 4; ++ranks) {
        CAPTURE(ranks);
        check_success(short_training(scene, output(ranks), ranks, width) + options, "2");
        CHECK(final_model(output(ranks)) == final_model(output(1)));
        for (const char* name : {"gaussians", "psnr", "effects"})
            CHECK(read_json(output(ranks) / "metrics.json").at(name) ==
                  read_json(output(1) / "metrics.json").at(name));
        const double loss = read_json(output(ranks) / "metrics.json").at("training_psnr");
        CHECK(loss == doctest::Approx(read_json(output(1) / "metrics.json").at("training_psnr").get<double>())
                          .epsilon(1e-6));
    }
    const auto metrics = read_json(output(1) / "metrics.json");
    CHECK(metrics.at("gaussians") > 3000);
    return metrics;
}

fs::path checkpoint(const fs::path& output, int iteration) {
    return output / "checkpoints" / ("iteration_" + std::to_string(iteration) + ".safetensors");
}

words small_run(const fs::path& output, int ranks) {
    return {"train",
            "-d",
            "synthetic:spheres,views=8",
            "-o",
            output,
            "-r",
            "32",
            "-i",
            "300",
            "--device",
            "cpu",
            "--quiet",
            "--deterministic",
            "--ranks",
            std::to_string(ranks)};
}

}  // namespace

TEST_CASE("ranks: any number of them writes the same model, with exposures and SH coefficients") {
    check_equal_models(
        "synthetic:spheres,exposure=0.4,response=0.6,gloss=0.7,vignetting=0.4,views=8",
        density_control +
            words{"--effects", "auto,+exposure,+response,+direction,+poses,+motion,+moving,+vignetting"});
}

TEST_CASE("ranks: any number of them begins the same effect half-way, from equal renders") {
    const auto metrics = check_equal_models("synthetic:spheres,scales=5,sky=0.8,vignetting=0.4",
                                            density_control + words{"--effects", "auto"}, 40);
    const auto& effects = metrics.at("effects");
    CHECK(std::ranges::any_of(effects, [](const auto& effect) {
        return effect.at("name") == "vignetting" && effect.at("on") == true &&
               effect.value("on_at_first", true) == false;
    }));
}

TEST_CASE("ranks: any number of them revises the SH degree alike, from equal measurements") {
    // The revision is in an iteration without densification, after which ranks have old Gaussians.
    check_equal_models(
        "synthetic:spheres,views=16,gloss=0.7",
        density_control + words{"--eval", "--sh-degree-interval", "33", "--test-iterations", "25"}, 96);
}

TEST_CASE("ranks: any number of them writes the same model, with a sky, depths, masks and compact moments") {
    check_equal_models("synthetic:spheres,sky=0.6,depths=0.02,passers=0.1,views=8",
                       density_control + words{"--effects", "auto,+sky,+depth,+direction", "--dropout", "0.1",
                                               "--precision", "compact"});
}

TEST_CASE("ranks: any number of them writes the same model, with three photos per iteration") {
    check_equal_models("synthetic:spheres,sky=0.6,depths=0.02,passers=0.1,exposure=0.4,views=8",
                       density_control + words{"--effects", "auto,+sky,+depth,+direction,+poses,+exposure",
                                               "--batch-size", "3"});
}

TEST_CASE("ranks: any number of them writes the same model, with another strategy and tests in between") {
    check_equal_models("synthetic:alpha,views=8",
                       {"-i", "120", "--strategy", "mcmc", "--max-cap", "4000", "--background", "random",
                        "--eval", "--test-iterations", "60"});
}

TEST_CASE("long: ranks: they score views together, and write the same model") {
    const temporary_folder folder;
    for (int ranks = 1; ranks <= 3; ++ranks) {
        CAPTURE(ranks);
        const fs::path output = folder / std::to_string(ranks);
        check_success(short_training("synthetic:spheres,views=8,points=800", output, ranks, 32) +
                          words{"-i", "1500", "--max-cap", "1500", "--strategy", "error"},
                      "2");
        CHECK(final_model(output) == final_model(folder / "1"));
        const auto metrics = read_json(output / "metrics.json");
        if (ranks > 1) CHECK(metrics.at("exchange").at("bytes").at("scores") > 0);
    }
}

TEST_CASE("ranks: one has no Gaussians if there are few, and the poses and models of all are the same") {
    const temporary_folder folder;
    const auto output = [&](int ranks) { return folder / std::to_string(ranks); };
    for (int ranks = 1; ranks <= 3; ++ranks) {
        CAPTURE(ranks);
        check_success(short_training("synthetic:spheres,views=8,points=20", output(ranks), ranks) +
                          words{"-i", "90", "--init", "given", "--max-cap", "20", "--eval", "--effects",
                                "poses", "--test-iterations", "30", "60"},
                      "2");
        CHECK(read_json(output(ranks) / "metrics.json").at("gaussians") == 20);
        CHECK(final_model(output(ranks)) == final_model(output(1)));
        CHECK(read_file(output(ranks) / "poses.json") == read_file(output(1) / "poses.json"));
    }
}

TEST_CASE("ranks: without --deterministic they agree about the model, too") {
    const temporary_folder folder;
    words options = short_training("synthetic:spheres,views=8", folder / "out", 3) + density_control;
    std::erase(options, "--deterministic");
    check_success(options, "6");
    CHECK(read_json(folder / "out/metrics.json").at("gaussians") > 3000);
}

TEST_CASE("ranks: a killed rank ends training with a sentence, and another number of ranks continues") {
    const temporary_folder folder;
    const fs::path killed = folder / "killed", whole = folder / "whole";
    check_success(small_run(whole, 1), "2");
    const words options = small_run(killed, 3) + words{"--checkpoint-every", "20"};
    std::chrono::steady_clock::time_point from;
    const outcome o = run_and_then(options, [&](pid_t process, const fs::path&) {
        wait_for(checkpoint(killed, 40));
        const auto ranks = children_of(process);
        REQUIRE(ranks.size() == 3);
        from = std::chrono::steady_clock::now();
        kill(ranks[1], SIGKILL);
    });
    CHECK(std::chrono::steady_clock::now() - from < std::chrono::seconds(15));
    CHECK(o.code == 3);
    CHECK(std::ranges::count(o.err, '\n') == 1);
    CHECK(says(o.err, {"error: rank 1 of 3 was killed by signal 9", "--resume"}));
    check_success(small_run(killed, 2) + words{"--resume"}, "2");
    CHECK(read_file(model_of(killed, 300)) == read_file(model_of(whole, 300)));
}

TEST_CASE("ranks: a signal saves the state, as without ranks") {
    const temporary_folder folder;
    const fs::path output = folder / "out";
    for (const auto& [signal, code] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
        const outcome o = run_and_then(small_run(output, 2) + words{"--resume", "--checkpoint-every", "20"},
                                       [&, number = signal](pid_t process, const fs::path&) {
                                           wait_for(checkpoint(output, number == SIGINT ? 20 : 120));
                                           kill(process, number);
                                       });
        CHECK(o.code == code);
        CHECK(std::ranges::count(o.err, '\n') == 1);
        CHECK(says(o.err, {"interrupted after iteration", "add --resume"}));
    }
}

TEST_CASE("ranks: errors are reported once, and leave nothing behind") {
    const words train{"train", "-d", "synthetic:spheres", "--ranks", "2"};
    check_refusal_without_trace(train + words{"--device", "cuda"}, {"--ranks", "CPU only", "--device cuda"});
    check_refusal_without_trace(train + words{"--viewer", "8080"}, {"--ranks", "--viewer"});
    check_refusal_without_trace(train + words{"--poses", "auto"}, {"--ranks", "--poses auto"});
    check_refusal_without_trace({"train", "-d", "no scene", "--ranks", "2", "--device", "cpu"}, {"no scene"});
    check_refusal_without_trace({"train", "-d", "synthetic:spheres", "--ranks", "0"}, {"--ranks", "'0'"});
    check_refusal_without_trace(train + words{"--gpus", "2"}, {"--ranks", "--gpus"});
    const words on_gpus{"train", "-d", "synthetic:spheres", "--gpus"};
    check_refusal_without_trace(on_gpus + words{"0"}, {"--gpus", "1 to 64, or all", "'0'"});
    check_refusal_without_trace(on_gpus + words{"2", "--device", "cpu"}, {"--gpus", "--device cpu"});
    check_refusal_without_trace(on_gpus + words{"all", "--viewer", "8080"}, {"--gpus", "--viewer"});
    check_refusal_without_trace(on_gpus + words{"64"}, {"--gpus 64", "GPU"});
}
