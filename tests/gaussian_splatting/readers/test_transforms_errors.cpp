// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <functional>
#include <string>

#include "transforms_scene.hpp"

namespace {

using namespace gs_test::transforms_scene;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;

}  // namespace

TEST_CASE("transforms files that say something impossible") {
    struct wrong_file {
        const char* what;
        std::function<void(json&)> apply;
        std::vector<std::string> words;
    };
    const auto set_matrix = [](json matrix) {
        return [matrix](json& file) { file["frames"][1]["transform_matrix"] = matrix; };
    };
    const wrong_file cases[] = {
        {"array", [](json& f) { f = json::array(); }, {"not a JSON object"}},
        {"no frames", [](json& f) { f.erase("frames"); }, {"field frames is missing"}},
        {"frames", [](json& f) { f["frames"] = 3; }, {"frames is not an array"}},
        {"number", [](json& f) { f = 3; }, {"not a JSON object"}},
        {"frames", [](json& f) { f["frames"] = json::object(); }, {"frames is not an array"}},
        {"frame", [](json& f) { f["frames"][1] = 3; }, {"frame 1", "not a JSON object"}},
        {"frame", [](json& f) { f["frames"][1] = json::array(); }, {"frame 1", "not a JSON object"}},
        {"no path", [](json& f) { f["frames"][1].erase("file_path"); }, {"frame 1", "file_path is missing"}},
        {"path", [](json& f) { f["frames"][1]["file_path"] = 3; }, {"frame 1", "file_path", "not a string"}},
        {"path",
         [](json& f) { f["frames"][1]["file_path"] = {"a"}; },
         {"frame 1", "file_path", "not a string"}},
        {"photo", [](json& f) { f["frames"][1]["file_path"] = "none"; }, {"frame 1", "none", "missing"}},
        {"long", [](json& f) { f["frames"][1]["file_path"] = std::string(5000, 'x'); }, {"too long"}},
        {"no angle", [](json& f) { f.erase("camera_angle_x"); }, {"frame 0", "camera_angle_x", "missing"}},
        {"angle",
         [](json& f) { f["camera_angle_x"] = 0; },
         {"frame 0", "camera_angle_x", "between 0 and pi"}},
        {"angle",
         [](json& f) { f["camera_angle_x"] = 3.2; },
         {"frame 0", "camera_angle_x", "between 0 and pi"}},
        {"angle",
         [](json& f) { f["camera_angle_x"] = "wide"; },
         {"frame 0", "camera_angle_x", "not a number"}},
        {"focal", [](json& f) { f["frames"][1]["fl_x"] = -1; }, {"frame 1", "focal length"}},
        {"width", [](json& f) { f["w"] = 0; }, {"frame 0", "w is 0", "whole number from 1"}},
        {"height", [](json& f) { f["h"] = 1e30; }, {"frame 0", "h is 1", "whole number from 1"}},
        {"no pose",
         [](json& f) { f["frames"][1].erase("transform_matrix"); },
         {"frame 1", "train_1", "transform_matrix is missing"}},
        {"3 rows", set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}), {"frame 1", "4x4 finite numbers"}},
        {"5 rows",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {0, 0, 0, 1}}),
         {"frame 1", "4x4 finite numbers"}},
        {"5 columns",
         set_matrix({{1, 0, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}),
         {"frame 1", "4x4 finite numbers"}},
        {"3 columns",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1}}),
         {"frame 1", "4x4 finite numbers"}},
        {"a number among rows",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, 1}),
         {"frame 1", "4x4 finite numbers"}},
        {"a row in a row",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1, {1}}}),
         {"frame 1", "4x4 finite numbers"}},
        {"no array", set_matrix("identity"), {"frame 1", "4x4 finite numbers"}},
        {"object",
         set_matrix({{"a", {1, 0, 0, 0}}, {"b", {0, 1, 0, 0}}, {"c", {0, 0, 1, 0}}, {"d", {0, 0, 0, 1}}}),
         {"frame 1", "4x4 finite numbers"}},
        {"an object among rows",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {{"a", 0}, {"b", 0}, {"c", 1}, {"d", 0}}, {0, 0, 0, 1}}),
         {"frame 1", "4x4 finite numbers"}},
        {"null",
         set_matrix({{1, 0, 0, nullptr}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}),
         {"frame 1", "train_1", "4x4 finite numbers"}},
        {"flat",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}}),
         {"frame 1", "singular"}},
        {"zero",
         set_matrix({{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}}),
         {"frame 1", "singular"}},
        {"scaled",
         set_matrix({{1.01, 0, 0, 0}, {0, 1.01, 0, 0}, {0, 0, 1.01, 0}, {0, 0, 0, 1}}),
         {"frame 1", "not a rotation"}},
        {"mirror",
         set_matrix({{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}),
         {"frame 1", "not a rotation"}},
        {"last row",
         set_matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1, 1}}),
         {"frame 1", "not a rotation"}},
        {"huge",
         set_matrix({{1e300, 0, 0, 0}, {0, 1e300, 0, 0}, {0, 0, 1e300, 0}, {0, 0, 0, 1}}),
         {"frame 1", "not a rotation"}},
        {"far",
         set_matrix({{1, 0, 0, 1e200}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}),
         {"frame 1", "translation", "1e30"}},
        {"pose of all",
         [](json& f) {
             f["transform_matrix"] = f["frames"][1]["transform_matrix"];
             f["frames"][1].erase("transform_matrix");
         },
         {"frame 1", "transform_matrix is missing"}},
        {"null number", [](json& f) { f["frames"][1]["cx"] = nullptr; }, {"frame 1", "cx is not a number"}},
        {"array", [](json& f) { f["frames"][1]["cx"] = {9}; }, {"frame 1", "cx is not a number"}},
        {"object", [](json& f) { f["cx"] = {{"cx", 9}}; }, {"frame 0", "cx is not a number"}},
    };
    for (const wrong_file& wrong : cases) {
        const temporary_folder folder;
        json file = transforms(folder.path(), "train", 2);
        wrong.apply(file);
        write_json(folder / "transforms_train.json", file);
        const std::string problem = error_of_loading(folder.path());
        CAPTURE(wrong.what);
        CAPTURE(problem);
        for (const std::string& word : wrong.words) CHECK(says(problem, {word}));
    }
}

TEST_CASE("NaN and infinity, as Python writes them, are traced to their frame") {
    for (const char* word : {"NaN", "Infinity", "-Infinity"}) {
        const temporary_folder folder;
        json file = transforms(folder.path(), "train", 2);
        file["frames"][1]["transform_matrix"][0][3] = "here";
        file["comment"] = "\"NaN\" within a text \\";
        std::string text = file.dump();
        text.replace(text.find("\"here\""), 6, word);
        write_file(folder / "transforms_train.json", text);
        CHECK(says(error_of_loading(folder.path()), {"frame 1", "train_1", "transform_matrix", "finite"}));
        const std::string frames = "{\"camera_angle_x\":1,\"frames\":[{\"file_path\":";
        write_file(folder / "transforms_train.json", frames + word + "}]}");
        CHECK(says(error_of_loading(folder.path()), {"frame 0", "file_path is not a string"}));
    }
}

TEST_CASE("what is not JSON is named by file, line and byte") {
    const temporary_folder folder;
    const auto file = folder / "transforms_train.json";
    write_file(file, "{\n \"frames\": [\n  oops\n ]\n}\n");
    CHECK(says(error_of_loading(folder.path()),
               {"transforms_train.json", "not valid JSON", "line 3", "byte 18"}));
    write_file(file, "");
    CHECK(says(error_of_loading(folder.path()), {"transforms_train.json", "not valid JSON", "line 1"}));
    write_file(file, "{\"camera_angle_x\": 1e999, \"frames\": []}");
    CHECK(says(error_of_loading(folder.path()), {"transforms_train.json", "too large", "line 1", "byte 24"}));
    const std::string whole = transforms(folder.path(), "train", 1).dump();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write_file(file, whole.substr(0, length));
        REQUIRE(says(error_of_loading(folder.path()), {"transforms_train.json", "not valid JSON"}));
    }
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    CHECK(says(error_of_loading(folder.path()), {"transforms_train.json"}));
}

TEST_CASE("photos of a Blender scene that are damaged or of no known kind") {
    const temporary_folder folder;
    write_json(folder / "transforms_train.json", transforms(folder.path(), "train", 2));
    write_file(folder / "train/train_1.png", "no image");
    CHECK(says(error_of_loading(folder.path()), {"train_1.png", "not a PNG"}));
}
