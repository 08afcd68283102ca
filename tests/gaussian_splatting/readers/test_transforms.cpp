// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "../../support/temporary_folder.hpp"
#include "readers/load_scene.hpp"

namespace {

using gs_test::error_of;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;
using nlohmann::json;

constexpr double rounding = 1e-12;  // some operations on doubles of about 1 to 100

void write_photo(const std::filesystem::path& file, int width = 20, int height = 16) {
    std::filesystem::create_directories(file.parent_path());
    gs::write_png(file, width, height,
                  std::vector<float>(static_cast<std::size_t>(3 * width * height), 0.5F));
}

json matrix_at(double x, double y, double z) {
    return {{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}};
}

/// Photos NAME_0.png and so on, whose cameras look along -z, and the file that describes them.
json transforms(const std::filesystem::path& folder, const std::string& name, int count) {
    json result = {{"camera_angle_x", 0.8}, {"frames", json::array()}};
    for (int i = 0; i < count; ++i) {
        const std::string path = "./" + name + "/" + name + "_" + std::to_string(i);
        write_photo(folder / (path + ".png"));
        result["frames"].push_back({{"file_path", path}, {"transform_matrix", matrix_at(i, 0, 3)}});
    }
    return result;
}

void write_json(const std::filesystem::path& file, const json& content) { write_file(file, content.dump(1)); }

gs::load_options options_for(const std::filesystem::path& folder, bool eval = false) {
    gs::load_options options;
    options.data = folder.string();
    options.eval = eval;
    return options;
}

void ignore(const std::string&) {}

gs::scene load(const std::filesystem::path& folder, bool eval = false) {
    return gs::load_scene(options_for(folder, eval), ignore);
}

std::string error_of_loading(const std::filesystem::path& folder, bool eval = false) {
    return error_of([&] { load(folder, eval); });
}

std::filesystem::path real_scene(const std::string& name) {
    const char* named = std::getenv("WARPAGG_DATA");
    const std::filesystem::path data =
        named ? std::filesystem::path(named) : std::filesystem::path(WARPAGG_SOURCE_DIR) / "../shared/data";
    return data / name;
}

double distance_from_identity(const glm::dmat3& matrix) {
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        largest = std::max(largest, glm::distance(matrix[column], glm::dmat3(1)[column]));
    return largest;
}

}  // namespace

TEST_CASE("a Blender camera looks along -z with y up, ours along +z with y down") {
    const temporary_folder folder;
    write_json(folder / "transforms_train.json", transforms(folder.path(), "train", 2));
    const gs::scene scene = load(folder.path());
    CHECK(scene.object_centered);
    CHECK(scene.points.empty());
    CHECK_FALSE(scene.has_alpha);
    REQUIRE(scene.train.size() == 2);
    CHECK(scene.train[0].name == "train/train_0.png");
    CHECK(scene.train[1].name == "train/train_1.png");
    const gs::camera& c = scene.train[1].camera;
    CHECK(std::pair{c.width, c.height} == std::pair{20, 16});
    CHECK(glm::distance(c.center(), glm::dvec3(1, 0, 3)) < rounding);
    const glm::dvec3 p = c.rotation * glm::dvec3(1.1, 0.2, 0.5) + c.translation;
    CHECK(glm::distance(p, glm::dvec3(0.1, -0.2, 2.5)) < rounding);
    // The horizontal angle spans the width; pixels are square.
    CHECK(c.fx == doctest::Approx(10 / std::tan(0.4)).epsilon(rounding));
    CHECK(c.fy == c.fx);
    CHECK(std::pair{c.cx, c.cy} == std::pair{10.0, 8.0});
}

TEST_CASE("a turned Blender camera") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 1);
    // It stands at x = 4 and looks along -x, its y axis along world z.
    file["frames"][0]["transform_matrix"] = {{0, 0, 1, 4}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}};
    write_json(folder / "transforms_train.json", file);
    const gs::camera c = load(folder.path()).train[0].camera;
    const glm::dvec3 p = c.rotation * glm::dvec3(1, 0.5, 0.25) + c.translation;
    CHECK(glm::distance(p, glm::dvec3(0.5, -0.25, 3)) < rounding);
    CHECK(glm::determinant(c.rotation) == doctest::Approx(1).epsilon(rounding));
}

TEST_CASE("training, test and validation files with and without eval") {
    const temporary_folder folder;
    write_json(folder / "transforms_train.json", transforms(folder.path(), "train", 3));
    CHECK(load(folder.path()).train.size() == 3);
    CHECK(says(error_of_loading(folder.path(), true), {"no test views", "3 for training"}));

    write_json(folder / "transforms_val.json", transforms(folder.path(), "val", 4));
    gs::scene scene = load(folder.path(), true);
    CHECK(scene.train.size() == 3);
    CHECK(scene.test.size() == 4);
    CHECK(load(folder.path()).train.size() == 7);

    write_json(folder / "transforms_test.json", transforms(folder.path(), "test", 2));
    scene = load(folder.path(), true);
    CHECK(scene.train.size() == 3);
    REQUIRE(scene.test.size() == 2);
    CHECK(scene.test[0].name == "test/test_0.png");
    scene = load(folder.path());
    CHECK(scene.train.size() == 5);
    CHECK(scene.test.empty());

    write_json(folder / "transforms_train.json", transforms(folder.path(), "train", 0));
    CHECK(says(error_of_loading(folder.path(), true), {"no training views", "2 held out"}));
}

TEST_CASE("file_path with or without its ending") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 4);
    file["frames"][0]["file_path"] = "train/train_0.png";
    file["frames"][1]["file_path"] = "train/photo.v1";  // a dot that is no ending
    write_photo(folder / "train/photo.v1.png");
    file["frames"][3]["file_path"] = "train/\\ Infinity";  // which is no number here
    write_photo(folder / "train/\\ Infinity.png");
    write_json(folder / "transforms_train.json", file);
    const gs::scene scene = load(folder.path());
    CHECK(scene.train[0].name == "train/train_0.png");
    CHECK(scene.train[1].name == "train/photo.v1.png");
    CHECK(scene.train[2].name == "train/train_2.png");
    CHECK(scene.train[3].name == "train/\\ Infinity.png");
}

TEST_CASE("intrinsics that are written down are preferred to the angle") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 2);
    file.update({{"fl_x", 30}, {"fl_y", 28.5}, {"cx", 9}, {"cy", 8.25}, {"w", 20}, {"h", 16}});
    file["frames"][1]["fl_x"] = 31;  // a frame's own comes first
    write_json(folder / "transforms_train.json", file);
    const gs::scene scene = load(folder.path());
    const gs::camera &a = scene.train[0].camera, &b = scene.train[1].camera;
    CHECK(std::array{a.fx, a.fy, a.cx, a.cy} == std::array{30.0, 28.5, 9.0, 8.25});
    CHECK(b.fx == 31);
    CHECK(b.fy == 28.5);

    // Recorded for photos twice as large, without an angle, and with one focal length for both axes.
    file.erase("camera_angle_x");
    file.erase("fl_y");
    file["w"] = 40;
    file["h"] = 32;
    write_json(folder / "transforms_train.json", file);
    const gs::camera half = load(folder.path()).train[0].camera;
    CHECK(std::array{half.fx, half.fy, half.cx, half.cy} == std::array{15.0, 15.0, 4.5, 4.125});

    file["h"] = 30;
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"train_0.png", "wrong size", "20x16", "40x30"}));
}

TEST_CASE("lens distortion in a transforms file is not ignored") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 1);
    file["k1"] = 0.2;
    write_json(folder / "transforms_train.json", file);
    std::string said;
    const gs::scene scene =
        gs::load_scene(options_for(folder.path()), [&](const std::string& line) { said += line; });
    CHECK(says(said, {"1 camera", "OPENCV", "pinhole"}));
    CHECK(scene.train[0].camera.fx > 10 / std::tan(0.4));  // pincushion: a narrower view
}

TEST_CASE("a camera model in a transforms file is that of its frame, or of all") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 2);
    file.update({{"fl_x", 9}, {"k1", 0.1}, {"k2", -0.02}, {"k3", 0.003}, {"k4", -0.0004}});
    file["camera_model"] = "OPENCV_FISHEYE";
    file["frames"][1]["camera_model"] = "OPENCV";
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"frame 1", "k4", "OPENCV_FISHEYE"}));
    file["frames"][1]["k4"] = 0;
    write_json(folder / "transforms_train.json", file);
    const gs::scene scene = load(folder.path());
    CHECK(scene.train[0].camera.fisheye.value().k() == std::array{0.1, -0.02, 0.003, -0.0004});
    CHECK_FALSE(scene.train[1].camera.fisheye);
    file["frames"][1]["camera_model"] = nullptr;  // not said
    write_json(folder / "transforms_train.json", file);
    CHECK(load(folder.path()).train[1].camera.fisheye);
    file["k1"] = -50;
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"train_0.png", "folds", "4 degrees"}));
    file["frames"][1]["camera_model"] = "EQUIRECTANGULAR";
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"frame 1", "EQUIRECTANGULAR", "pinhole images"}));
    file["camera_model"] = 5;
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"camera_model is not a string"}));
}

TEST_CASE("masks of a transforms file leave out where they are black") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 2);
    file["frames"][1]["mask_path"] = "masks/second.png";
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"frame 1", "masks/second.png", "does not exist"}));
    const gs::camera c = [&] {
        auto options = options_for(folder.path());
        options.masks = false;
        return gs::load_scene(options, [](const std::string&) {}).train[1].camera;
    }();
    std::vector<float> planes;
    for (int plane = 0; plane < 3; ++plane)
        for (int y = 0; y < c.height; ++y)
            for (int x = 0; x < c.width; ++x) planes.push_back(x < c.width / 2 ? 0.0f : 1.0f);
    std::filesystem::create_directories(folder / "masks");
    gs::write_png(folder / "masks/second.png", c.width, c.height, planes);
    const gs::scene scene = load(folder.path());
    CHECK_FALSE(scene.train[0].pixels.has_mask);
    REQUIRE(scene.train[1].pixels.has_mask);
    const auto alpha = [&](int x) {
        return int{scene.train[1].pixels.rgba[4 * static_cast<std::size_t>(x) + 3]};
    };
    CHECK(alpha(0) == 0);
    CHECK(alpha(c.width - 1) == 255);
    file["frames"][1]["mask_path"] = 3;
    write_json(folder / "transforms_train.json", file);
    CHECK(says(error_of_loading(folder.path()), {"mask_path is not a string"}));
}

TEST_CASE("a rotation that is slightly off is made exact") {
    const temporary_folder folder;
    json file = transforms(folder.path(), "train", 1);
    const double s = 1.0003;
    file["frames"][0]["transform_matrix"] = {
        {s * 0.6, -s * 0.8, 2e-4, 1}, {0.8, 0.6, 0, 2}, {0, 1e-4, 1, 3}, {0, 0, 0, 1}};
    write_json(folder / "transforms_train.json", file);
    const gs::camera c = load(folder.path()).train[0].camera;
    CHECK(distance_from_identity(glm::transpose(c.rotation) * c.rotation) < rounding);
    CHECK(glm::distance(c.center(), glm::dvec3(1, 2, 3)) < rounding);
    // Not far from where it was: by about as much as the matrix was off.
    CHECK(glm::distance(glm::transpose(c.rotation)[0], glm::dvec3(0.6, 0.8, 0)) < 1e-3);
}

TEST_CASE("transparent photos are noticed") {
    const auto folder = real_scene("lego");
    if (!std::filesystem::exists(folder)) {
        MESSAGE("skipped: " << folder.string() << " is not there");
        return;
    }
    auto options = options_for(folder, true);
    options.resolution = 4;
    const gs::scene scene = gs::load_scene(options, ignore);
    CHECK(scene.train.size() == 100);
    CHECK(scene.test.size() == 200);
    CHECK(scene.has_alpha);
    for (const auto* views : {&scene.train, &scene.test})
        for (const gs::view& view : *views) {
            REQUIRE(std::pair{view.camera.width, view.camera.height} == std::pair{100, 100});
            REQUIRE(view.pixels.rgba.size() == 4 * 100 * 100);
            // Every camera looks at the origin, where the model stands, from 4.03 away.
            const glm::dvec3 origin = view.camera.translation;
            REQUIRE(origin.z == doctest::Approx(4.0311).epsilon(1e-4));
            REQUIRE(std::hypot(origin.x, origin.y) < 1e-3);
        }
    CHECK(scene.train[0].camera.fx ==
          doctest::Approx(50 / std::tan(0.5 * 0.6911112070083618)).epsilon(rounding));
}

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

TEST_CASE("photos of a Blender scene that are damaged or of no known kind") {
    const temporary_folder folder;
    write_json(folder / "transforms_train.json", transforms(folder.path(), "train", 2));
    write_file(folder / "train/train_1.png", "no image");
    CHECK(says(error_of_loading(folder.path()), {"train_1.png", "not a PNG"}));
}
