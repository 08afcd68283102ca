// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "run_program.hpp"
#include "small_scene.hpp"
#include "small_training.hpp"

using namespace gs_test;

namespace {

constexpr int photos = 12;

/// Writes a scene of photos that all differ. Each decoded photo has 1536 bytes.
void write_scene(const fs::path& folder) {
    small_scene scene;
    scene.photos = photos;
    scene.write(folder);
    for (int i = 0; i < photos; ++i) {
        std::vector<float> planes(static_cast<std::size_t>(3 * photo_width * photo_height));
        for (std::size_t k = 0; k < planes.size(); ++k)
            planes[k] = 0.5F + 0.4F * std::sin(0.1F * static_cast<float>(k) + static_cast<float>(i));
        gs::write_png(folder / "images" / small_scene::photo(i), photo_width, photo_height, planes);
    }
}

words training_of(const fs::path& folder, const std::string& output, int iterations) {
    return words{"train",    "-d",  folder.string(),   "-o", (folder / output).string(), "--eval",
                 "--device", "cpu", "--deterministic", "-i", std::to_string(iterations)};
}

std::string model_in(const fs::path& output, int iterations) {
    return contents(output).at(fs::relative(model_of(output, iterations), output).string());
}

}  // namespace

TEST_CASE("--photo-memory trains on photos in files, and writes the same model") {
    const temporary_folder folder;
    write_scene(folder.path());
    const outcome resident = run(training_of(folder.path(), "resident", 60));
    const outcome streamed =
        run(training_of(folder.path(), "streamed", 60) + words{"--photo-memory", "15kB"});
    REQUIRE(resident.code == 0);
    REQUIRE(streamed.code == 0);
    CHECK(resident.out.find("photos stay in their files") == std::string::npos);
    CHECK(streamed.out.find("photos stay in their files") != std::string::npos);
    CHECK(streamed.out.find("expects ") != std::string::npos);
    CHECK(model_in(folder / "streamed", 60) == model_in(folder / "resident", 60));
    const json a = read_json(folder / "resident/metrics.json"),
               b = read_json(folder / "streamed/metrics.json");
    CHECK(a.at("psnr") == b.at("psnr"));
    CHECK(read_json(folder / "streamed/settings.json").at("photo_memory") == 15000);
}

TEST_CASE("--photo-memory that is too small is refused with the smallest sufficient size") {
    const temporary_folder folder;
    write_scene(folder.path());
    check_refusal_without_trace(training(folder.path()) + words{"--photo-memory", "5kB"},
                                {"--photo-memory", "at least 12kB"});
    check_success(training_of(folder.path(), "out", 5) + words{"--photo-memory", "12kB", "-q"});
    check_refusal(
        words{"train", "-o", (folder / "none").string()} + small_spheres + words{"--photo-memory", "5kB"},
        {"synthetic:spheres", "--photo-memory"});
}

TEST_CASE("--photo-memory: a photo that is lost during training ends it with a checkpoint") {
    const temporary_folder folder;
    write_scene(folder.path());
    constexpr int iterations = 2000;
    check_success(training_of(folder.path(), "whole", iterations) + words{"-q"});
    const words options = training_of(folder.path(), "lost", iterations) + words{"--photo-memory", "15kB"};
    const fs::path photo = folder.path() / "images" / small_scene::photo(5), hidden = folder / "hidden.png";
    const fs::path first = folder / "lost/checkpoints/iteration_100.safetensors";
    const outcome ended =
        run_and_then(options + words{"--checkpoint-iterations", "100"}, [&](pid_t, const fs::path&) {
            for (int i = 0; i < 3000 && !fs::exists(first); ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            fs::rename(photo, hidden);
        });
    CHECK(ended.code == 2);
    CHECK(ended.err.find(photo.string()) != std::string::npos);
    CHECK(ended.err.find("--resume") != std::string::npos);
    fs::rename(hidden, photo);
    check_success(options + words{"--resume", "-q"});
    CHECK(model_in(folder / "lost", iterations) == model_in(folder / "whole", iterations));
}

TEST_CASE("--gpu-memory stops the growth of the model") {
    const temporary_folder folder;
    const auto gaussians = [&](const char* name, const words& options) {
        const words train{"train",      "-i",   "300",       "-o",   (folder / name).string(),
                          "--strategy", "mcmc", "--max-cap", "20000"};
        const outcome ended = run(train + small_spheres + options);
        REQUIRE(ended.code == 0);
        const json metrics = read_json(folder / name / "metrics.json");
        const bool stopped = metrics.at("growth_limited_by") == "gpu_memory";
        CHECK((ended.out.find("growth stops") != std::string::npos) == stopped);
        CHECK(stopped == (std::string(name) == "limited"));
        return metrics.at("gaussians").get<int>();
    };
    CHECK(gaussians("free", {}) == 20000);
    CHECK(gaussians("limited", {"--gpu-memory", "6MB"}) < 18000);
}

TEST_CASE("--precision: moments are compact if memory is short, and a resumed run keeps its precision") {
    const temporary_folder folder;
    const auto trained = [&](const words& options, const char* iterations = "10") {
        const words train{"train",     "-i",   iterations, "-o", (folder / "output").string(),
                          "--max-cap", "20000"};
        const outcome ended = run(train + small_spheres + options);
        REQUIRE(ended.code == 0);
        return ended.out;
    };
    const auto precision = [&] { return read_json(folder / "output" / "settings.json").at("precision"); };
    trained({});
    CHECK(precision() == "float");
    trained({"--overwrite", "--gpu-memory", "6MB", "--deterministic"});
    CHECK(precision() == "float");
    trained({"--overwrite", "--gpu-memory", "6MB", "--precision", "float"});
    CHECK(precision() == "float");
    trained({"--overwrite", "--gpu-memory", "6MB", "--checkpoint-every", "10"});
    CHECK(precision() == "compact");
    const std::string resumed = trained({"--resume", "--precision", "float"}, "20");
    CHECK(says(resumed,
               {"--precision remains compact, as in the checkpoint", "continuing after iteration 10"}));
    CHECK(precision() == "compact");
}
