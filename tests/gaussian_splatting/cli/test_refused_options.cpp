// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "engine/engine.hpp"
#include "run_program.hpp"
#include "small_training.hpp"

using namespace gs_test;

TEST_CASE("contradictory options are refused") {
    check_refusal_without_trace(train_spheres + words{"--white-background", "--background", "black"},
                                {"--white-background", "--background"});
    check_refusal_without_trace(train_spheres + words{"--test-every", "4"}, {"--test-every", "--eval"});
    check_refusal_without_trace(train_spheres + words{"-i", "20", "--test-iterations", "5"},
                                {"--test-iterations", "--eval"});
    check_refusal_without_trace(train_spheres + words{"--lpips", "weights"}, {"--lpips", "--eval"});
    check_refusal_without_trace(train_spheres + words{"-i", "20", "--save-iterations", "10", "21"},
                                {"--save-iterations", "21", "20"});
    check_refusal_without_trace(train_spheres + words{"--save-iterations", "0"}, {"--save-iterations", "0"});
    check_refusal_without_trace(
        train_spheres + words{"-i", "20", "--num-downscales", "2", "--resolution-schedule", "10"},
        {"--num-downscales 2", "--resolution-schedule 10", "20"});
    check_refusal_without_trace(
        train_spheres + words{"-i", "20", "--prune-share", "0.5", "--densify-until-iter", "20"},
        {"--prune-share", "--densify-until-iter", "at 20"});
    check_refusal_without_trace(train_spheres + words{"--budget", "2000", "--max-cap", "1999"},
                                {"--budget 2000", "--max-cap 1999"});
    check_refusal_without_trace(train_spheres + words{"--budget", "2000", "--densify-grad-threshold", "1e-4"},
                                {"--budget", "--densify-grad-threshold"});
    check_refusal_without_trace(train_spheres + words{"--seconds", "5", "--iterations", "20"},
                                {"--seconds and --iterations exclude each other"});
    check_refusal_without_trace(train_spheres + words{"--seconds", "5", "--deterministic"},
                                {"--deterministic", "give --iterations instead of --seconds"});
    check_refusal_without_trace(train_spheres + words{"--seconds", "0"}, {"--seconds must be", "'0'"});
    check_refusal_without_trace(train_spheres + words{"--iterations", "100,50"},
                                {"--iterations must be", "'100,50'", "7000,100:6500"});
    check_refusal_without_trace({"render", "model.ply", "--orbit-views", "3", "-d", "synthetic:spheres"},
                                {"--orbit-views", "--data"});
    check_refusal_without_trace({"render", "model.ply", "--eval"}, {"--eval", "--data"});
    check_refusal_without_trace({"render", "model.ply", "--images", "photos"}, {"--images", "--data"});
    check_refusal_without_trace({"render", "model.ply", "--background", "random"},
                                {"--background", "random"});
}

TEST_CASE("a missing file of LPIPS weights is refused before training") {
    check_refusal_without_trace(train_spheres + words{"--eval", "--device", "cpu", "--lpips", "no/weights"},
                                {"no/weights"});
}

TEST_CASE("options that a synthetic scene has no use for are refused") {
    check_refusal_without_trace(train_spheres + words{"--images", "photos"}, {"--images", "synthetic"});
    check_refusal_without_trace(train_spheres + words{"--eval", "--test-every", "4"},
                                {"--test-every", "synthetic"});
}

TEST_CASE("an unknown option is refused with the nearest known one") {
    check_refusal_without_trace(train_spheres + words{"--itertions", "20"}, {"--itertions", "--iterations"});
    check_refusal_without_trace(train_spheres + words{"--sh_degre=2"}, {"--sh-degre", "--sh-degree"});
    check_refusal_without_trace({"render", "model.ply", "--orbit-vews", "3"},
                                {"--orbit-vews", "--orbit-views"});
    check_refusal_without_trace(train_spheres + words{"stray"}, {"stray"});
}

TEST_CASE("an option without its value, or with one too many, is refused") {
    check_refusal(train_spheres + words{"-o", "nowhere", "-i"}, {"--iterations needs a value"});
    check_refusal(train_spheres + words{"-o", "nowhere", "--save-iterations"},
                  {"--save-iterations needs a value"});
    check_refusal_without_trace(train_spheres + words{"-i", "20", "--iterations", "30"},
                                {"--iterations is given 2 times"});
    check_refusal_without_trace(train_spheres + words{"--eval=yes"}, {"--eval takes no value", "--eval=yes"});
    check_refusal_without_trace({"render", "model.ply", "other.ply"}, {"'other.ply'", "render"});
}

TEST_CASE("a missing or unknown command is refused") {
    check_refusal({}, {"train", "evaluate", "render"});
    check_refusal({"trian", "-d", "synthetic:spheres"}, {"'trian'", "train", "evaluate", "render"});
    check_refusal({"--quiet", "train"}, {"'--quiet'", "train", "evaluate", "render"});
    check_refusal({"train", "-o", "nowhere"}, {"--data"});
    check_refusal({"train", "-d", "synthetic:spheres"}, {"--output"});
    check_refusal({"evaluate", "-d", "synthetic:spheres"}, {"ply"});
}

TEST_CASE("values out of range are refused") {
    const std::vector<std::array<std::string, 3>> cases{{"-r", "0", "--resolution"},
                                                        {"-r", "-3", "--resolution"},
                                                        {"-r", "1.5", "--resolution"},
                                                        {"-i", "0", "--iterations"},
                                                        {"-i", "abc", "--iterations"},
                                                        {"-i", "", "--iterations"},
                                                        {"-i", "5x", "--iterations"},
                                                        {"--sh-degree", "4", ""},
                                                        {"--sh-degree", "-1", ""},
                                                        {"--seed", "-1", ""},
                                                        {"--max-cap", "0", ""},
                                                        {"--sh-degree-interval", "0", ""},
                                                        {"--save-iterations", "abc", ""},
                                                        {"--position-lr-init", "nan", ""},
                                                        {"--position-lr-final", "0", ""},
                                                        {"--feature-lr", "inf", ""},
                                                        {"--opacity-lr", "-1e-3", ""},
                                                        {"--scaling-lr", "1e-60", ""},
                                                        {"--rotation-lr", "fast", ""},
                                                        {"--densify-grad-threshold", "nan", ""},
                                                        {"--opacity-reset-interval", "0", ""},
                                                        {"--densification-interval", "0", ""},
                                                        {"--densify-from-iter", "-1", ""},
                                                        {"--densify-until-iter", "1.5", ""},
                                                        {"--sh-lr", "0", ""},
                                                        {"--budget", "0", ""},
                                                        {"--prune-share", "1", ""},
                                                        {"--prune-share", "nan", "below 1"},
                                                        {"--prune-share", ".", "below 1"},
                                                        {"--num-downscales", "9", ""},
                                                        {"--resolution-schedule", "0", ""},
                                                        {"--sh-update-interval", "0", ""},
                                                        {"--background", "beige", ""},
                                                        {"--device", "tpu", ""},
                                                        {"--quality", "worst", ""},
                                                        {"-i", "99999999999999999999", "--iterations"}};
    for (const auto& [option, value, long_name] : cases)
        check_refusal_without_trace(train_spheres + words{option, value},
                                    {long_name.empty() ? option : long_name, value});
}

TEST_CASE("training that does not stay finite ends and leaves earlier results alone") {
    check_refusal_without_trace({"train", "-d", "synthetic:spheres", "-r", "32", "-i", "20", "--device",
                                 "cpu", "-q", "--opacity-lr", "1e38"},
                                {"iteration 1", "view ", "opacity of Gaussian"});
}

TEST_CASE("--device cuda is refused where there is no GPU") {
    std::string reason;
    if (gs::train::cuda_is_available(reason)) {
        MESSAGE("there is a GPU: not tested");
        return;
    }
    check_refusal_without_trace(train_spheres + words{"--device", "cuda"}, {"--device cuda", "GPU"});
}

TEST_CASE("--help, --version and the options that begin with --print succeed") {
    for (const words& asked : {words{"--help"}, words{"-h"}, words{"train", "--help"}, words{"render", "-h"},
                               words{"--version"}, words{"--print-reference"}, words{"--print-man-page"},
                               words{"--print-completion", "bash"}, words{"--print-completion", "zsh"}}) {
        const outcome o = run(asked);
        CHECK(o.code == 0);
        CHECK(!o.out.empty());
        CHECK(o.err == "");
    }
}
