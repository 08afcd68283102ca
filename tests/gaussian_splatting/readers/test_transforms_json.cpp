// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "transforms_scene.hpp"

namespace {

using namespace gs_test::transforms_scene;
using gs_test::error_of;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;

}  // namespace

TEST_CASE("a transforms file may spell its texts and numbers as JSON allows, and nest what is not read") {
    const temporary_folder folder;
    write_photo(folder / "caf\xC3\xA9 \xF0\x9F\x98\x80/a\"b.png");
    write_file(
        folder / "transforms_train.json",
        "{\"camera_angle_x\":8e-1 , \"frames\" :\r\n[\t{\"file_path\": "
        "\"caf\\u00e9 \\uD83D\\uDE00\\/a\\\"b\", \"transform_matrix\": "
        "[[1,-0,0E0,1e-400],[0,1.0,0,2.5e+0],[0,0,1,-3],[0,0,0,1]], \"cx\": 7, \"c\\u0078\": 9}],"
        "\"unread\": [[], {}, [{\"\": [null, true, false, \"\\u0000\"]}], {\"frames\": 1, \"cx\": {}}]}");
    const gs::scene scene = load(folder.path());
    REQUIRE(scene.train.size() == 1);
    CHECK(scene.train[0].name == "caf\xC3\xA9 \xF0\x9F\x98\x80/a\"b.png");
    CHECK(scene.train[0].camera.center() == glm::dvec3(0, 2.5, -3));
    CHECK(scene.train[0].camera.cx == 9);  // of a field that is said twice the last one counts
    CHECK(scene.train[0].camera.fx == doctest::Approx(10 / std::tan(0.4)));

    write_file(folder / "transforms_train.json", "{\"frames\": [], \"frames\": []}");
    CHECK(says(error_of_loading(folder.path()), {"transforms_train.json", "frames twice"}));
}

TEST_CASE("what nests in a value that is not read is not taken for what is") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 1);
    const json nested = {{"file_path", 3}, {"transform_matrix", {{1, 2}}}, {"cx", nullptr}, {"frames", 3}};
    file["a"] = file["z"] = nested;
    file["frames"][0]["a"] = file["frames"][0]["z"] = {nested, {nested}};
    write_json(folder / "transforms_train.json", file);
    const gs::scene scene = load(folder.path());
    REQUIRE(scene.train.size() == 1);
    CHECK(scene.train[0].camera.center() == glm::dvec3(0, 0, 3));
    CHECK(scene.train[0].camera.cx == 10);
}

TEST_CASE("of a transform_matrix that is said twice the last one counts") {
    const temporary_folder folder;
    write_photo(folder / "a.png");
    const std::string sound = matrix_at(1, 2, 3).dump();
    const auto load_with = [&](const std::string& first, const std::string& second) {
        write_file(folder / "transforms_train.json",
                   R"({"camera_angle_x":1,"frames":[{"file_path":"a","transform_matrix":)" + first +
                       R"(,"transform_matrix":)" + second + "}]}");
        return load(folder.path());
    };
    for (const std::string wrong : {"[[1]]", "3", "{}", "[]"}) {
        CHECK(load_with(wrong, sound).train[0].camera.center() == glm::dvec3(1, 2, 3));
        CHECK(says(error_of([&] { load_with(sound, wrong); }), {"frame 0", "4x4 finite numbers"}));
    }
}

TEST_CASE("values of a transforms file may nest as deep as they like") {
    const temporary_folder folder;
    std::string text = transforms(folder.path(), "train", 1).dump();
    text.pop_back();
    text += ",\"unread\":";
    for (int i = 0; i < 100000; ++i) text += "[1,{\"a\":";
    text += "1";
    for (int i = 0; i < 100000; ++i) text += "},1]";
    write_file(folder / "transforms_train.json", text + "}");
    CHECK(load(folder.path()).train.size() == 1);
    write_file(folder / "transforms_train.json", text);
    CHECK(says(error_of_loading(folder.path()), {"transforms_train.json", "not valid JSON"}));
}

TEST_CASE("a text, a number or a gap of a transforms file may take some kilobytes") {
    const auto strings = [](std::size_t size) { return '"' + std::string(size - 2, 'x') + '"'; };
    const auto escapes = [](std::size_t size) {
        std::string text = "\"";
        while (text.size() + 2 < size) text += "\\\"";
        return text + (text.size() + 1 < size ? "x\"" : "\"");
    };
    const auto numbers = [](std::size_t size) { return "0." + std::string(size - 2, '1'); };
    const auto blanks = [](std::size_t size) { return "1" + std::string(size - 1, ' '); };
    const auto lines = [](std::size_t size) { return "1" + std::string(size / 8, '\n'); };
    const auto brackets = [](std::size_t size) {
        return "1," + std::string(size / 2 - 2, '[') + std::string(size / 2 - 2, ']');
    };
    const auto infinities = [](std::size_t size) {
        std::string text = "1";
        while (text.size() + 10 < size) text += ",-Infinity";
        return text;
    };
    const auto literals = [](std::size_t size) {
        std::string text = "1";
        while (text.size() + 5 < size) text += ",null";
        return text;
    };
    const auto digits = [](std::size_t size) {
        std::string text = "\"";
        while (text.size() + 3 < size) text += ",1";
        return text + "\"";
    };
    const auto before_blanks = [=](std::size_t size) {
        return strings(size / 2) + std::string(size - size / 2, ' ');
    };
    const temporary_folder folder;
    const std::string whole = transforms(folder.path(), "train", 1).dump();
    const std::function<std::string(std::size_t)> kinds[] = {
        strings, escapes, numbers, blanks, lines, brackets, infinities, literals, digits, before_blanks};
    for (const auto& kind : kinds) {
        CAPTURE(kind(100));
        const auto load_with = [&](const std::string& values) {
            write_file(folder / "transforms_train.json",
                       whole.substr(0, whole.size() - 1) + ",\n\"unread\":[" + values + ",1]}");
            load(folder.path());
        };
        CHECK_NOTHROW(load_with(kind(4080)));
        CHECK_NOTHROW(load_with(kind(3000) + "," + kind(3000)));  // each counts for itself
        const std::string problem = error_of([&] { load_with(kind(4120)); });
        CHECK(says(problem, {"transforms_train.json", "too long"}));
    }
    write_file(folder / "transforms_train.json", "{\n\"" + std::string(5000, 'x') + "\": 1}");
    CHECK(says(error_of_loading(folder.path()), {"too long", "line 2", "byte 4099"}));
}
