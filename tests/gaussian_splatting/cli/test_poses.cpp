// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "../poses/fake_programs.hpp"
#include "run_program.hpp"

using namespace gs_test;

namespace {

words training_with_poses(const fs::path& data, const fs::path& output) {
    return {"train",         "-d",     data.string(), "--poses", "auto",     "-o",
            output.string(), "--eval", "-i",          "5",       "--device", "cpu"};
}

}  // namespace

TEST_CASE("train --poses auto trains on a folder of photos, and other commands read its scene") {
    const temporary_folder folder;
    const fs::path photos = folder / "photos", output = folder / "new/out", scene = output / "colmap";
    write_photos(photos, 9);
    fake_programs fakes;
    fakes.models = "9";
    fakes.install();
    check_success(training_with_poses(photos, output));
    CHECK(read_json(output / "metrics.json").contains("psnr"));
    const json settings = read_json(output / "settings.json");
    CHECK(settings.dump().find("\"poses\":\"auto\"") != std::string::npos);

    const std::string model = model_of(output, 5).string();
    check_success({"evaluate", model, "-d", scene.string(), "--eval"});
    check_success({"render", model, "-d", scene.string(), "-o", (folder / "renders").string()});
    check_success({"inspect", "-d", scene.string()});
    fakes.calls();
    const outcome again = run(training_with_poses(photos, output) + words{"--overwrite"});
    CHECK(again.code == 0);
    CHECK(says(again.out, {"using the camera poses in", "again"}));
    CHECK_FALSE(fs::exists(scene / "models"));
    CHECK(fakes.calls().empty());
}

TEST_CASE("train names the missing step for photos without poses") {
    const temporary_folder folder;
    write_photos(folder / "photos", 6);
    check_refusal_without_trace({"train", "-d", (folder / "photos").string()},
                                {"without camera poses", "--poses auto", "COLMAP"});
    check_refusal({"train", "-d", (folder / "photos").string(), "-o", (folder / "out").string(), "--poses",
                   "given", "--video-frames", "20"},
                  {"--video-frames needs --poses auto"});
}

TEST_CASE("train --poses auto leaves no trace if COLMAP is not installed") {
    const temporary_folder folder;
    write_photos(folder / "photos", 6);
    const fake_programs fakes;
    fakes.install_only({});
    check_refusal_without_trace({"train", "-d", (folder / "photos").string(), "--poses", "auto"},
                                {"needs COLMAP", "apt-get install colmap"});
}
