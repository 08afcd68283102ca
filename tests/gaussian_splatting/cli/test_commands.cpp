// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../evaluation/patterns.hpp"
#include "image/image.hpp"
#include "run_program.hpp"
#include "small_scene.hpp"
#include "small_training.hpp"
#include "writers/ply/ply.hpp"

using namespace gs_test;

namespace {

std::vector<std::string> images_in(const fs::path& folder, int expected_width, int expected_height) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const gs::image image = gs::read_image(entry.path());
        CHECK(image.width == expected_width);
        CHECK(image.height == expected_height);
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

void check_metrics(const json& metrics) {
    CHECK(metrics.at("psnr").get<double>() > 15);
    CHECK(metrics.at("ssim").get<double>() > 0.3);
    CHECK(metrics.at("ssim").get<double>() < 1);
    REQUIRE(metrics.at("views").size() == 8);
    double sum = 0;
    for (const json& view : metrics.at("views")) {
        CHECK(view.at("name").get<std::string>().ends_with(".png"));
        CHECK(view.at("ssim").is_number());
        sum += view.at("psnr").get<double>();
    }
    CHECK(sum / 8 == doctest::Approx(metrics.at("psnr").get<double>()).epsilon(1e-12));
    for (const char* stage : {"load", "train", "evaluate"})
        CHECK(metrics.at("seconds").at(stage).get<double>() > 0);
    CHECK(metrics.at("iterations") == 60);
    CHECK(metrics.at("gaussians").get<int>() > 0);
    CHECK(says(metrics.at("device").get<std::string>(), {"cpu"}));
    CHECK(metrics.at("accumulator") == "native");
    REQUIRE(!metrics.at("effects").empty());
    for (const json& effect : metrics.at("effects")) {
        CHECK(effect.at("name").is_string());
        CHECK(effect.at("on").is_boolean());
        CHECK(!effect.at("reason").get<std::string>().empty());
    }
    CHECK(metrics.at("seed") == 7);
}

}  // namespace

TEST_CASE("train writes a model, measures and renders, and evaluate and render read them") {
    const temporary_folder folder;
    const fs::path output = folder / "deep/results", model = model_of(output, 60);
    const outcome trained =
        run(small_training(output) +
            words{"--seed", "7", "--save_iterations", "30", "--sh_degree", "1", "--test_iterations", "20"});
    CHECK(trained.err == "");
    REQUIRE(trained.code == 0);
    CHECK(says(trained.out, {"held-out PSNR", model.string(), (output / "metrics.json").string()}));

    const json metrics = read_json(output / "metrics.json");
    check_metrics(metrics);
    REQUIRE(metrics.at("tests").size() == 1);
    const json& test = metrics.at("tests")[0];
    CHECK(test.at("iteration") == 20);
    CHECK(test.at("psnr").get<double>() < metrics.at("psnr").get<double>());
    CHECK(test.at("seconds").get<double>() > 0);
    CHECK(test.at("seconds").get<double>() < metrics.at("seconds").at("train").get<double>());
    const json settings = read_json(output / "settings.json");
    CHECK(settings.at("data") == "synthetic:spheres");
    CHECK(settings.at("iterations") == 60);
    CHECK(settings.at("sh_degree") == 1);  // `_` and `-` are alike
    CHECK(settings.at("resolution") == 32);
    CHECK(settings.at("seed") == 7);

    CHECK(gs::read_ply(model_of(output, 30)).count() > 0);
    const gs::gaussians saved = gs::read_ply(model);
    CHECK(saved.sh_degree == 1);
    CHECK(saved.count() == metrics.at("gaussians").get<std::size_t>());
    const auto renders = images_in(output / "test/ours_60/renders", 32, 32);
    CHECK(renders.size() == 8);
    CHECK(images_in(output / "test/ours_60/gt", 32, 32) == renders);

    SUBCASE("evaluate measures the same") {
        const fs::path again = folder / "again";
        check_success(words{"evaluate", model.string(), "-o", again.string()} + small_spheres);
        const json measured = read_json(again / "metrics.json");
        // The file holds every bit of the parameters, and a pixel is blended in one order only. But threads
        // add up errors over pixels as they finish: the last bits of sums of 3072 doubles may differ.
        constexpr double rounding = 1e-12;
        for (const char* measure : {"psnr", "ssim"})
            CHECK(measured.at(measure).get<double>() ==
                  doctest::Approx(metrics.at(measure).get<double>()).epsilon(rounding));
        CHECK(measured.at("views").size() == metrics.at("views").size());
        CHECK(contents(again / "test") == contents(output / "test/ours_60"));
    }
    SUBCASE("evaluate without an output says it only") {
        const outcome said = run(words{"evaluate", model.string()} + small_spheres);
        CHECK(said.code == 0);
        CHECK(says(said.out, {"PSNR", "8 views"}));
    }
    SUBCASE("render from the scene's cameras draws what training drew") {
        const fs::path images = folder / "images";
        check_success(words{"render", model.string(), "-o", images.string()} + small_spheres);
        CHECK(images_in(images, 32, 32) == renders);
        CHECK(contents(images) == contents(output / "test/ours_60/renders"));
    }
    SUBCASE("render from the model alone draws an orbit") {
        const fs::path images = folder / "orbit";
        check_success({"render", model.string(), "-o", images.string(), "--orbit-views", "3", "-r", "40",
                       "--device", "cpu"});
        CHECK(images_in(images, 40, 40) == words{"00000.png", "00001.png", "00002.png"});
    }
}

TEST_CASE("train reads a COLMAP scene") {
    const temporary_folder folder;
    small_scene{}.write(folder / "scene");
    check_success(training(folder / "scene") + words{"-o", (folder / "results").string()});
    CHECK(read_json(folder / "results/metrics.json").at("psnr").is_null());  // no views were held out
}

TEST_CASE("evaluate leaves out masked pixels, or measures them with --no-masks") {
    const temporary_folder folder;
    const fs::path scene = folder / "scene", measured = folder / "measured", all = folder / "all";
    small_scene{}.write(scene);
    fs::create_directories(scene / "masks");
    constexpr std::size_t pixels = std::size_t{photo_width} * photo_height;
    std::vector<float> right_half(3 * pixels, 1.0F);
    for (std::size_t i = 0; i < right_half.size(); ++i)
        if (i % photo_width < photo_width / 2) right_half[i] = 0;
    for (int i = 0; i < 4; ++i) {
        // The left half is bright, which no model of the gray photos explains.
        std::vector<float> photo(3 * pixels, 0.5F);
        for (std::size_t k = 0; k < photo.size(); ++k)
            if (k % photo_width < photo_width / 2) photo[k] = 1;
        gs::write_png(scene / "images" / small_scene::photo(i), photo_width, photo_height, photo);
        gs::write_png(scene / "masks" / small_scene::photo(i), photo_width, photo_height, right_half);
    }
    check_success(training(scene) + words{"-o", (folder / "trained").string(), "-q"});
    const words evaluation{"evaluate", model_of(folder / "trained", 5).string(), "-d", scene.string(), "-q",
                           "-o"};
    check_success(evaluation + words{measured.string()});
    check_success(evaluation + words{all.string(), "--no-masks"});
    CHECK(read_json(measured / "metrics.json").at("psnr").get<double>() >
          read_json(all / "metrics.json").at("psnr").get<double>() + 0.5);
}

TEST_CASE("models have the coordinates of the scene, far from the origin and in any unit") {
    for (const auto& [offset, unit] : {std::pair(0.0, 1e-4), std::pair(1e4, 1.0), std::pair(0.0, 1e4)}) {
        CAPTURE(offset);
        CAPTURE(unit);
        const temporary_folder folder;
        small_scene scene;
        scene.offset = offset;
        scene.unit = unit;
        scene.write(folder / "scene");
        const fs::path output = folder / "results", again = folder / "again", model = model_of(output, 5);
        const words data{"-d", (folder / "scene").string(), "--eval", "--test-every", "2", "--device", "cpu"};
        check_success(words{"train", "-i", "5", "-o", output.string()} + data);
        const gs::gaussians saved = gs::read_ply(model);
        REQUIRE(saved.count() == 8);
        for (const float x : saved.mean)
            CHECK(std::abs(static_cast<double>(x) / unit - offset) == doctest::Approx(0.5).epsilon(0.1));
        for (const float s : saved.log_scale)
            CHECK(static_cast<double>(s) - std::log(unit) == doctest::Approx(0).epsilon(0.1));

        check_success(words{"evaluate", model.string(), "-o", again.string()} + data);
        const double psnr = read_json(output / "metrics.json").at("psnr").get<double>();
        CHECK(read_json(again / "metrics.json").at("psnr").get<double>() ==
              doctest::Approx(psnr).epsilon(1e-12));
        check_success(words{"render", model.string(), "-o", (folder / "images").string()} + data);
        CHECK(contents(folder / "images") == contents(output / "test/ours_5/renders"));

        // The orbit sees something, wherever it is.
        check_success({"render", model.string(), "-o", (folder / "orbit").string(), "--orbit-views", "1",
                       "-r", "40", "--device", "cpu"});
        const gs::image image = gs::read_image(folder / "orbit/00000.png");
        CHECK(std::ranges::any_of(std::vector<std::uint8_t>(image.rgba.begin() + 4 * (20 * 40 + 15),
                                                            image.rgba.begin() + 4 * (20 * 40 + 25)),
                                  [](std::uint8_t level) { return level > 20 && level < 255; }));
    }
}

TEST_CASE("inspect prints and writes the effects that a scene needs") {
    const temporary_folder folder;
    const fs::path file = folder / "effects.json";
    const outcome o = run({"inspect", "-d", "synthetic:spheres,gloss=0.6,exposure=0.3", "-o", file.string()});
    CAPTURE(o.err);
    CHECK(o.code == 0);
    const auto json = nlohmann::json::parse(read_file(file));
    REQUIRE(json.at("effects").size() == 13);
    for (const auto& effect : json.at("effects")) {
        const auto name = effect.at("name").get<std::string>();
        CHECK(effect.at("recommended").get<bool>() == (name == "direction" || name == "exposure"));
        CHECK(says(o.out, {name, effect.at("evidence").get<std::string>(),
                           effect.at("expected").get<std::string>()}));
    }
    check_refusal({"inspect", "-d", "synthetic:spheres,shine=1"}, {"'shine'", "gloss"});
    check_refusal({"inspect", "-d", "synthetic:spheres", "-o", (folder / "none/effects.json").string()},
                  {"none"});
}

TEST_CASE("doctor reports the devices, and which programs are installed or how to get them") {
    const temporary_folder folder;
    write_file(folder / "colmap", "#!/bin/sh\n");
    fs::permissions(folder / "colmap", fs::perms::owner_all);
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder.path().c_str(), 1);
    const outcome o = run({"doctor"});
    setenv("PATH", path.c_str(), 1);
    REQUIRE(o.code == 0);
    CHECK(o.err == "");
    CHECK(says(o.out, {"version  ", "CPU      cpu, ", "memory   ", " GiB\n", "GPU      ", "MPI      ",
                       "colmap   installed", "ffmpeg   missing (to get it: apt-get install ffmpeg)",
                       "ffprobe  missing"}));
    check_refusal({"doctor", "--quiet"}, {"doctor takes no options: leave out --quiet"});
}

TEST_CASE("train and evaluate write the metrics of each view as JSON, CSV and Markdown") {
    const temporary_folder folder;
    const fs::path output = folder / "trained", again = folder / "again", weights = folder / "weights";
    gs_test::write_lpips_weights(weights, "0,1");
    check_success(small_training(output) + words{"--lpips", weights.string()});
    check_success(
        words{"evaluate", model_of(output, 60).string(), "-o", again.string(), "--lpips", weights.string()} +
        small_spheres);
    for (const fs::path& results : {output, again}) {
        const json metrics = read_json(results / "metrics.json");
        CHECK(metrics.at("renders_rounded_to_8_bits") == false);
        CHECK(metrics.at("lpips_input_range") == std::vector<int>{0, 1});
        for (const char* measure : {"ssim_interior", "psnr_8bit", "lpips"}) {
            CHECK(metrics.at(measure).get<double>() > 0);
            for (const json& view : metrics.at("views")) CHECK(view.at(measure).get<double>() > 0);
        }
        const std::string csv = read_file(results / "metrics.csv"), text = read_file(results / "metrics.md");
        CHECK(csv.starts_with("name,psnr,ssim,ssim_interior,psnr_8bit,lpips\n"));
        CHECK(std::ranges::count(csv, '\n') == 10);
        CHECK(std::ranges::count(text, '\n') == 11);
        for (const json& view : metrics.at("views")) {
            const std::string name = view.at("name").get<std::string>();
            CHECK(says(csv, {"\n" + name + ","}));
            CHECK(says(text, {"\n| " + name + " |"}));
        }
    }
    CHECK(read_json(output / "settings.json").at("lpips") == weights.string());
    // LPIPS sums in a fixed order, and the model file holds every bit of the parameters.
    CHECK(read_json(again / "metrics.json").at("lpips") == read_json(output / "metrics.json").at("lpips"));
}
