// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "transforms_scene.hpp"

namespace {

using namespace gs_test::transforms_scene;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;

constexpr double rounding = 1e-12;  // some operations on doubles of about 1 to 100

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
    CHECK(scene.rendered);
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
    CHECK(says(error_of_loading(folder.path()), {"frame 1", "panorama", "twice as wide as high"}));
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
