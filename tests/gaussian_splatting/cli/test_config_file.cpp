// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <string>

#include "cli/parse.hpp"
#include "run_program.hpp"
#include "small_training.hpp"

using namespace gs_test;

namespace {

/// Parses a training whose further options are in a file with this text.
gs::cli::settings parsed(const std::string& text, const words& more = {}) {
    const temporary_folder folder;
    write_file(folder / "config.json", text);
    return gs::cli::parse(words{"train", "--config", folder / "config.json"} + more);
}

std::string problem(const std::string& text, const words& more = {"-d", "scene", "-o", "results"}) {
    return error_of([&] { parsed(text, more); });
}

}  // namespace

TEST_CASE("--config: the file sets options of every kind, and the command line overrides them") {
    const auto s = parsed(R"({"data": "scene", "output": "results", "iterations": 300, "opacity_lr": 0.03,
                              "save_iterations": [10, 20], "eval": true, "deterministic": false,
                              "revised_opacity": false, "budget": null, "loss": "l1_ssim"})",
                          {"-i", "200", "-o", "others"});
    CHECK(s.scene.data == "scene");
    CHECK(s.output == "others");
    CHECK(s.schedule.iterations == 200);
    CHECK(s.schedule.opacity_lr == 0.03);
    CHECK(s.save_iterations == std::set{10, 20});
    CHECK(s.scene.eval);
    CHECK_FALSE(s.deterministic);
    CHECK_FALSE(s.densification.of<gs::train::adaptive_config>().revised_opacity);
    CHECK(s.given.at("iterations") == 200);
    CHECK(s.given.at("opacity_lr") == 0.03);
    CHECK_FALSE(s.given.contains("budget"));
    CHECK_FALSE(s.given.contains("seed"));
    const words scene{"-d", "scene", "-o", "results"};
    CHECK(parsed(R"({"white_background": true, "quiet": true})", scene).background ==
          gs::cli::background_kind::white);
    CHECK(parsed(R"({"white_background": true})", scene + words{"--background", "black"}).background ==
          gs::cli::background_kind::black);
}

TEST_CASE("--config: options of the file follow the rules of the command line") {
    CHECK(says(problem(R"({"itertions": 5})"), {"config.json", "'itertions'", "is iterations"}));
    CHECK(says(problem(R"({"iterations": 0})"), {"--iterations must be", "'0'"}));
    CHECK(says(problem(R"({"iterations": "many"})"), {"--iterations must be", "'many'"}));
    CHECK(says(problem(R"({"iterations": true})"), {"'iterations'", "cannot have the value true"}));
    CHECK(says(problem(R"({"iterations": [5]})"), {"'iterations'", "cannot have the value [5]"}));
    CHECK(says(problem(R"({"eval": 1})"), {"'eval'", "cannot have the value 1"}));
    CHECK(says(problem(R"({"save_iterations": [[5]]})"), {"'save_iterations'", "cannot have the value"}));
    CHECK(says(problem(R"({"test_every": 5})"), {"--test-every needs --eval"}));
    CHECK(says(problem(R"({"mcmc_noise": 5})"), {"--mcmc-noise belongs to --strategy mcmc"}));
    CHECK(says(problem(R"([5])"), {"config.json is no JSON object"}));
    CHECK(says(problem(R"({"iterations": 5)"), {"config.json is no valid JSON"}));
    CHECK(says(problem(R"({"given": 5})"), {"config.json", "'given' is no object"}));
    CHECK(says(error_of([] {
                   gs::cli::parse({"train", "--config", "missing.json"});
               }),
               {"cannot read missing.json"}));
}

TEST_CASE("--config: settings.json repeats a run, and also with other options") {
    const temporary_folder folder;
    const fs::path first = folder / "first", again = folder / "again", shorter = folder / "shorter";
    check_success({"train", "-d", "synthetic:spheres,exposure=0.5", "-r", "24", "--device", "cpu", "-i", "60",
                   "--quality", "fast", "--deterministic", "--seed", "3", "-o", first.string(), "-q"});
    const words repeat{"train", "-q", "--config", first / "settings.json", "-o"};
    check_success(repeat + words{again.string()});
    CHECK(read_file(model_of(again, 60)) == read_file(model_of(first, 60)));
    json before = read_json(first / "settings.json"), after = read_json(again / "settings.json");
    for (json* all : {&before, &after}) {
        all->erase("output");
        all->at("given").erase("output");
    }
    CHECK(before == after);
    check_success(repeat + words{shorter.string(), "-i", "20"});
    CHECK(fs::exists(model_of(shorter, 20)));
    check_refusal(words{"train", "-q", "--config", first / "settings.json"}, {"holds an earlier run"});
}

TEST_CASE("--seconds: settings.json has the plan of iterations, which repeats the run") {
    const temporary_folder folder;
    const fs::path first = folder / "first", again = folder / "again", third = folder / "third";
    const words options{"-d", "synthetic:spheres", "-r", "24",     "--device", "cpu", "--quality", "best",
                        "-q", "--save-iterations", "5",  "1000000"};
    check_success(words{"train", "--seconds", "0.5", "-o", first} + options);
    const json settings = read_json(first / "settings.json"), metrics = read_json(first / "metrics.json");
    const int last = metrics.at("iterations");
    CHECK(settings.at("seconds").is_null());
    CHECK_FALSE(settings.at("given").contains("seconds"));
    CHECK(settings.at("given").at("iterations") == settings.at("iterations"));
    CHECK(settings.at("iterations").get<std::string>().ends_with(":" + std::to_string(last)));
    CHECK(fs::exists(model_of(first, 5)));
    CHECK(fs::exists(model_of(first, last)));
    // The plan replaces time, so repetitions can be deterministic.
    for (const fs::path& output : {again, third})
        check_success({"train", "-q", "--deterministic", "--config", first / "settings.json", "-o", output});
    CHECK(read_file(model_of(again, last)) == read_file(model_of(third, last)));
    const json repeated = read_json(again / "settings.json");
    CHECK(repeated.at("iterations") == settings.at("iterations"));
    CHECK(repeated.at("densify_until_iter") == settings.at("densify_until_iter"));
}

TEST_CASE("--seconds: a time that is too short to plan ends after a few steps and a warning") {
    const temporary_folder folder;
    const outcome o = run({"train", "--seconds", "1e-6", "-o", folder / "run", "-d", "synthetic:spheres",
                           "-r", "24", "--device", "cpu", "--log-level", "warning"});
    REQUIRE(o.code == 0);
    CHECK(says(o.out, {"warning: training took", "instead of 1e-06 s", "too short", "raise --seconds"}));
}

TEST_CASE("--log-level: warnings appear from level warning on, and other messages from level info on") {
    const temporary_folder folder;
    for (const char* level : {"error", "warning", "info"}) {
        CAPTURE(std::string(level));
        const fs::path output = folder / level;
        write_file(output / "checkpoints/iteration_20.safetensors.part/in_the_way", "");
        const outcome o = run(small_training(output) +
                              words{"--resume", "--checkpoint-iterations", "20", "--log-level", level});
        REQUIRE(o.code == 0);
        CHECK(says(o.out, {"warning: cannot write"}) == (level != std::string("error")));
        CHECK(says(o.out, {"held-out PSNR"}) == (level == std::string("info")));
        CHECK(o.err == "");
    }
}
