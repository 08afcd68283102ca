// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "run_program.hpp"
#include "small_scene.hpp"
#include "writers/ply/ply.hpp"

using namespace gs_test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

void check_scene_is_refused(const small_scene& scene, const words& culprits, const words& options = {}) {
    const temporary_folder data;
    scene.write(data.path());
    check_refusal_without_trace(training(data.path()) + options, culprits);
}

/// `spoil` changes a valid scene.
template <class Spoil>
void check_spoilt_scene_is_refused(const Spoil& spoil, const words& culprits) {
    const temporary_folder data;
    small_scene{}.write(data.path());
    spoil(data.path());
    check_refusal_without_trace(training(data.path()), culprits);
}

gs::gaussians small_model() {
    gs::gaussians model;
    for (const float x : {-0.5F, 0.0F, 0.5F}) {
        model.mean.insert(model.mean.end(), {x, 0, 0});
        model.log_scale.insert(model.log_scale.end(), {-2, -2, -2});
        model.quaternion.insert(model.quaternion.end(), {1, 0, 0, 0});
        model.opacity.push_back(1);
        model.sh_constant.insert(model.sh_constant.end(), {1, 0, -1});
    }
    return model;
}

void replace(std::string& text, const std::string& part, const std::string& by) {
    const std::size_t at = text.find(part);
    REQUIRE(at != std::string::npos);
    text.replace(at, part.size(), by);
}

/// `evaluate` and `render` with a valid scene, and `render` without a scene.
void check_model_is_refused(const std::string& ply, const words& culprits) {
    const temporary_folder data;
    small_scene{}.write(data.path());
    check_refusal_without_trace({"evaluate", ply, "-d", data.path().string()}, culprits);
    check_refusal_without_trace({"render", ply, "-d", data.path().string()}, culprits);
    check_refusal_without_trace({"render", ply}, culprits);
}

}  // namespace

TEST_CASE("train refuses a scene that does not exist") {
    const temporary_folder folder;
    check_refusal_without_trace(training(folder / "nowhere"), {(folder / "nowhere").string()});
    check_refusal_without_trace(training(folder.path()), {folder.path().string(), "is not a scene"});
    write_file(folder / "file", "x");
    check_refusal_without_trace(training(folder / "file"), {(folder / "file").string(), "is not a scene"});
    check_refusal_without_trace({"train", "-d", "synthetic:NOPE"}, {"NOPE", "spheres", "alpha"});
}

TEST_CASE("train refuses a COLMAP scene with invalid cameras or poses") {
    small_scene scene;
    SUBCASE("no cameras") {
        scene.cameras = 0;
        check_scene_is_refused(scene, {"cameras.bin", "no cameras"});
    }
    SUBCASE("an unknown camera model") {
        scene.camera_model = 77;
        check_scene_is_refused(scene, {"cameras.bin", "77", "PINHOLE"});
    }
    SUBCASE("a pose that is not a number") {
        scene.depth = not_a_number;
        check_scene_is_refused(scene, {"images.bin", "photo_0.png", "not finite"});
    }
    SUBCASE("a rotation that is not a number") {
        scene.rotation = {1, not_a_number, 0, 0};
        check_scene_is_refused(scene, {"images.bin", "photo_0.png", "not finite"});
    }
    SUBCASE("a rotation that is none") {
        scene.rotation = {0, 0, 0, 0};
        check_scene_is_refused(scene, {"images.bin", "photo_0.png", "rotation"});
    }
    SUBCASE("no images") {
        scene.photos = 0;
        check_scene_is_refused(scene, {"images.bin", "no images"});
    }
    SUBCASE("nothing left to train on") {
        scene.photos = 1;
        check_scene_is_refused(scene, {"no training views", "1 held out"}, {"--eval"});
    }
}

TEST_CASE("train refuses a COLMAP scene with a truncated or too long file") {
    for (const std::string name : {"cameras.bin", "images.bin", "points3D.bin"}) {
        const auto spoil = [&](const auto& change) {
            return [&, change](const fs::path& data) {
                const fs::path file = data / "sparse/0" / name;
                std::string text = read_file(file);
                change(text);
                write_file(file, text);
            };
        };
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text.resize(text.size() - 3); }),
                                      {name, "truncated"});
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text.clear(); }), {name, "truncated"});
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text += "more"; }), {name, "too long"});
        // A count that no memory could hold is not believed.
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text[7] = '\x7f'; }),
                                      {name, "truncated"});
    }
}

TEST_CASE("train refuses a scene with an unreadable photo") {
    const auto photo = [](const fs::path& data) { return data / "images/photo_2.png"; };
    check_spoilt_scene_is_refused([&](const fs::path& data) { fs::remove(photo(data)); }, {"photo_2.png"});
    check_spoilt_scene_is_refused([](const fs::path& data) { fs::remove_all(data / "images"); }, {"images"});
    check_spoilt_scene_is_refused(
        [&](const fs::path& data) { write_file(photo(data), std::string(500, '\x5a')); }, {"photo_2.png"});
    check_spoilt_scene_is_refused([&](const fs::path& data) { write_file(photo(data), ""); },
                                  {"photo_2.png"});
    check_spoilt_scene_is_refused(
        [&](const fs::path& data) { small_scene::write_photo(photo(data), photo_height, photo_width); },
        {"photo_2.png", "wrong size", "16x24", "24x16"});
    // Half of a PNG has a good header.
    check_spoilt_scene_is_refused(
        [&](const fs::path& data) {
            const std::string whole = read_file(photo(data));
            write_file(photo(data), whole.substr(0, whole.size() / 2));
        },
        {"photo_2.png"});
    // The signature and the header of an image of 0x0 pixels, with its right checksum.
    const std::string no_pixels{"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\0\0\0\0\0\x08\x02\0\0\0\xb4\xe9\xeb\x45",
                                33};
    check_spoilt_scene_is_refused([&](const fs::path& data) { write_file(photo(data), no_pixels); },
                                  {"photo_2.png"});
}

TEST_CASE("evaluate and render refuse an invalid model") {
    const temporary_folder folder;
    const fs::path file = folder / "model.ply";
    gs::write_ply(file, small_model());
    std::string text = read_file(file);
    SUBCASE("it is not there") {
        fs::remove(file);
        check_model_is_refused(file.string(), {file.string()});
    }
    SUBCASE("a field is missing") {
        replace(text, "property float opacity\n", "");
        write_file(file, text);
        check_model_is_refused(file.string(), {file.string(), "opacity"});
    }
    SUBCASE("the header promises more than there is") {
        replace(text, "element vertex 3", "element vertex 3000000");
        write_file(file, text);
        check_model_is_refused(file.string(), {file.string(), "3000000"});
    }
    SUBCASE("the header promises less than there is") {
        replace(text, "element vertex 3", "element vertex 2");
        write_file(file, text);
        check_model_is_refused(file.string(), {file.string()});
    }
    SUBCASE("it is no PLY") {
        write_file(file, "solid cube\n");
        check_model_is_refused(file.string(), {file.string()});
    }
    SUBCASE("it holds nothing to draw") {
        gs::write_ply(file, gs::gaussians());
        check_refusal_without_trace({"render", file.string()}, {file.string(), "no Gaussians"});
    }
}

TEST_CASE("all commands refuse an output that cannot be written") {
    const temporary_folder folder;
    const fs::path data = folder / "scene", model = folder / "model.ply", file = folder / "file";
    small_scene{}.write(data);
    gs::write_ply(model, small_model());
    write_file(file, "mine");
    const auto before = contents(folder.path());
    const std::vector<words> commands{
        training(data), {"evaluate", model.string(), "-d", data.string()}, {"render", model.string()}};
    for (const words& command : commands)
        for (const std::string& output : words{file.string(), (file / "below").string(), "/proc/nope"})
            check_refusal(command + words{"-o", output}, {output});
    CHECK(contents(folder.path()) == before);
}
