// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>
#include <sys/types.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "../cli/run_program.hpp"
#include "../evaluation/patterns.hpp"
#include "../training/engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "rank_processes.hpp"
#include "ranks/run.hpp"
#include "training/initialize.hpp"

using namespace gs_test;
using gs::ranks::communicator;

namespace {

/// The name and the bits of all measurements of each view.
std::string text_of(const gs::evaluate::held_out_report& report) {
    std::string text;
    for (const auto& view : report.views) {
        text += view.name;
        for (const auto& measure : gs::evaluate::view_measures)
            if (const auto value = measure.of(view))
                text += " " + std::to_string(std::bit_cast<std::uint64_t>(*value));
        text += "\n";
    }
    return text;
}

/// Measures held-out views in a rank. Each rank writes its report to a file. Computes LPIPS if the folder
/// has `weights`.
void measure_in(communicator& all, std::size_t views, const fs::path& folder) {
    omp_set_num_threads(1);  // so that the views of a rank are several batches
    gs::scene scene = small_scene("synthetic:spheres", 16);
    scene.test.resize(views);
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, scene.test);
    engine->set_model(gs::from_points(scene.points, 0, 200, 1));
    std::optional<gs::evaluate::lpips_network> network;
    if (fs::exists(folder / "weights")) network.emplace(folder / "weights");
    const auto report = gs::evaluate::measure_held_out_views(*engine, scene, {0.5f, 0, 1},
                                                             {.folder = folder / "images",
                                                              .fits_exposure = true,
                                                              .network = network ? &*network : nullptr,
                                                              .ranks = &all});
    std::ofstream(folder / std::to_string(all.rank())) << text_of(report);
}

void check_equal_reports(std::size_t views, bool has_lpips) {
    CAPTURE(views);
    std::map<std::string, std::string> expected;
    for (int ranks = 1; ranks <= 3; ++ranks) {
        CAPTURE(ranks);
        const temporary_folder folder;
        if (has_lpips) write_lpips_weights(folder / "weights", "0,1");
        const auto end = gs::ranks::run(ranks, [&](communicator& all) {
            measure_in(all, views, folder.path());
            return 0;
        });
        REQUIRE(end.reason == "");
        auto found = contents(folder.path());
        if (ranks == 1) {
            expected = found;
            CHECK(std::ranges::count(found.at("0"), '\n') == static_cast<std::ptrdiff_t>(views));
            CHECK(contents(folder / "images/renders").size() == views);
            CHECK(contents(folder / "images/gt").size() == views);
        }
        for (int other = 1; other < ranks; ++other) {
            CHECK(found.at(std::to_string(other)) == expected.at("0"));
            found.erase(std::to_string(other));
        }
        CHECK((found == expected));
    }
}

/// The pictures that a web page contains.
words pictures_in(const fs::path& page) {
    const std::string text = read_file(page), start = "src=\"data:image";
    words all;
    for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at + 1))
        all.push_back(text.substr(at, text.find('"', at + start.size()) - at));
    return all;
}

words training_with_refinement(const fs::path& output, int ranks, int width) {
    return {"train",
            "-d",
            "synthetic:spheres,poses=1,exposure=0.4,views=8",
            "-o",
            output,
            "-r",
            std::to_string(width),
            "-i",
            "20",
            "--eval",
            "--test-iterations",
            "10",
            "--effects",
            "poses,exposure",
            "--device",
            "cpu",
            "--quiet",
            "--no-viewer",
            "--deterministic",
            "--ranks",
            std::to_string(ranks)};
}

}  // namespace

TEST_CASE("evaluation in ranks: all get the report and files of one, with more or fewer views than ranks") {
    for (const std::size_t views : {0, 1, 2, 5}) check_equal_reports(views, false);
}

TEST_CASE("long: evaluation in ranks: LPIPS is that of one rank") { check_equal_reports(2, true); }

TEST_CASE("evaluation in ranks: poses, exposures and refined cameras are those of one rank") {
    const temporary_folder folder;
    const fs::path one = folder / "1";
    for (int ranks = 1; ranks <= 3; ++ranks) {
        CAPTURE(ranks);
        const fs::path output = folder / std::to_string(ranks);
        check_success(training_with_refinement(output, ranks, 16), std::to_string(ranks).c_str());
        auto metrics = read_json(output / "metrics.json"), expected = read_json(one / "metrics.json");
        for (auto* all : {&metrics, &expected}) {
            for (const char* of_machine : {"seconds", "iterations_per_second", "densify_seconds", "stages",
                                           "peak_host_bytes", "device", "exchange", "pairs_per_iteration"})
                all->erase(of_machine);
            for (const char* of_training : {"training_psnr", "history"}) all->erase(of_training);
            all->at("tests").at(0).erase("seconds");
        }
        CHECK(metrics == expected);
        CHECK(metrics.at("views").size() == 8);
        CHECK(metrics.at("views").at(7).at("refined_psnr") > 0);
        for (const char* file : {"metrics.csv", "poses.json", "exposures.json"})
            CHECK(read_file(output / file) == read_file(one / file));
        CHECK((contents(output / "test") == contents(one / "test")));
        CHECK(pictures_in(output / "report.html") == pictures_in(one / "report.html"));
    }
}

TEST_CASE("evaluation in ranks: the report shows the training views of one rank if none is held out") {
    const temporary_folder folder;
    for (int ranks = 1; ranks <= 3; ++ranks) {
        CAPTURE(ranks);
        const fs::path output = folder / std::to_string(ranks);
        check_success({"train", "-d", "synthetic:spheres,exposure=0.4,views=2", "-o", output, "-r", "16",
                       "-i", "4", "--effects", "exposure", "--device", "cpu", "--quiet", "--no-viewer",
                       "--deterministic", "--ranks", std::to_string(ranks)},
                      std::to_string(ranks).c_str());
        CHECK(pictures_in(output / "report.html").size() == 6);
        CHECK(pictures_in(output / "report.html") == pictures_in(folder / "1/report.html"));
    }
}

TEST_CASE("evaluation in ranks: a killed rank ends the program with a sentence, and the model is complete") {
    const temporary_folder folder;
    const fs::path output = folder / "out";
    std::chrono::steady_clock::time_point from;
    const outcome o = run_and_then(
        training_with_refinement(output, 2, 32),
        [&](pid_t process, const fs::path&) {
            wait_for(output / "test/ours_20/gt");
            const auto ranks = children_of(process);
            REQUIRE(ranks.size() == 2);
            from = std::chrono::steady_clock::now();
            kill(ranks[1], SIGKILL);
        },
        "2");
    CHECK(std::chrono::steady_clock::now() - from < std::chrono::seconds(15));
    CHECK(o.code == 3);
    CHECK(std::ranges::count(o.err, '\n') == 1);
    CHECK(says(o.err, {"error: rank 1 of 2 was killed by signal 9"}));
    CHECK(fs::exists(model_of(output, 20)));
    CHECK_FALSE(fs::exists(output / "metrics.json"));
}
