// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "../../support/temporary_folder.hpp"
#include "known_scene.hpp"

namespace {

using gs_test::check_views;
using gs_test::error_of;
using gs_test::known_scene;
using gs_test::load;
using gs_test::options_for;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;
using nlohmann::json;

/// The camera file. The axes x, y, z of the app are y, z, x of the scene.
json camera_json(const gs::camera& c) {
    const glm::dmat3 axes = glm::transpose(c.rotation);
    const glm::dvec3 center = c.center();
    json file = {{"fx", c.fx},       {"fy", c.fy},         {"cx", c.cx},      {"cy", c.cy},
                 {"width", c.width}, {"height", c.height}, {"blur_score", 90}};
    for (int row = 0; row < 3; ++row) {
        const int axis = (row + 1) % 3;
        const double values[] = {axes[0][axis], -axes[1][axis], -axes[2][axis], center[axis]};
        for (int column = 0; column < 4; ++column)
            file["t_" + std::to_string(row) + std::to_string(column)] = values[column];
    }
    return file;
}

/// Writes the scene with this prefix of the folders of cameras and photos. Returns a camera file.
json write_scene(const std::filesystem::path& folder, const gs::scene& known,
                 const std::string& prefix = "") {
    for (std::size_t i = 0; i < known.train.size(); ++i) {
        const std::string stem = "100" + std::to_string(i);
        gs_test::write_photo(folder / "keyframes" / (prefix + "images") / (stem + ".png"),
                             known.train[i].pixels);
        write_file(folder / "keyframes" / (prefix + "cameras") / (stem + ".json"),
                   camera_json(known.train[i].camera).dump());
    }
    return camera_json(known.train[0].camera);
}

std::string messages_of_loading(const std::filesystem::path& folder) {
    std::string said;
    gs::load_scene(options_for(folder), [&](const std::string& line) { said += line + "\n"; });
    return said;
}

}  // namespace

TEST_CASE("polycam: a scene is read as it was written") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_scene(folder.path(), known);
    const gs::scene read = load(folder.path());
    check_views(read, known);
    CHECK(read.points.empty());
    CHECK_FALSE(read.object_centered);
    CHECK(says(messages_of_loading(folder.path()), {"no corrected photos", "no depth maps"}));
}

TEST_CASE("polycam: corrected cameras and photos are preferred, and their black border is masked") {
    const temporary_folder folder;
    gs::scene known = known_scene();
    write_scene(folder.path(), known);
    for (gs::view& one : known.train) one.camera.fx += 1;
    write_scene(folder.path(), known, "corrected_");
    const gs::scene read = load(folder.path());
    CHECK(read.train[0].camera.fx == doctest::Approx(known.train[0].camera.fx));
    const gs::image& photo = read.train[0].pixels;
    CHECK(photo.is_masked(24 * 48 + 14));
    CHECK_FALSE(photo.is_masked(24 * 48 + 15));
    CHECK_FALSE(photo.is_masked(24 * 48 + 32));
    CHECK(photo.is_masked(24 * 48 + 33));
    gs::load_options options = options_for(folder.path());
    options.masks = false;
    CHECK_FALSE(gs::load_scene(options, {}).train[0].pixels.has_mask);
}

TEST_CASE("polycam: blurry photos are left out") {
    const temporary_folder folder;
    json camera = write_scene(folder.path(), known_scene());
    camera["blur_score"] = 24.9;
    write_file(folder / "keyframes/cameras/1000.json", camera.dump());
    CHECK(load(folder.path()).train.size() == 3);
    CHECK(says(messages_of_loading(folder.path()), {"left out", "blur score below 25: 1\n"}));
    for (const char* stem : {"1001", "1002", "1003"})
        write_file(folder / "keyframes/cameras" / (std::string(stem) + ".json"), camera.dump());
    CHECK(says(error_of([&] { load(folder.path()); }), {"all photos", "blur score"}));
}

TEST_CASE("polycam: depth maps give points with the colors of the photos, where the sensor is certain") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_scene(folder.path(), known);
    // Each map is half as wide as its photo. All depths are 2.5 m, apart from the right column.
    std::vector<std::uint16_t> depths(24 * 24, 2500), confidence(24 * 24, 65535);
    for (std::size_t row = 0; row < 24; ++row) {
        depths[24 * row + 23] = row < 12 ? 0 : 5001;
        for (std::size_t x = 0; x < 12; ++x) confidence[24 * row + x] = 32639;
    }
    for (const char* stem : {"1000", "1002"})
        gs_test::write_gray(folder / "keyframes/depth" / (std::string(stem) + ".png"), 24, 24, depths);
    gs_test::write_gray(folder / "keyframes/confidence/1002.png", 24, 24, confidence);
    const gs::scene read = load(folder.path());
    REQUIRE(read.points.size() == 24 * 23 + 24 * 11);
    CHECK(says(messages_of_loading(folder.path()), {"816 points", "depth maps"}));
    const auto check = [&](std::size_t point, const gs::view& by) {
        const auto seen = by.camera.see(read.points[point].position).value();
        CHECK(seen.depth == doctest::Approx(2.5));
        const auto pixel = static_cast<std::size_t>(seen.y) * 48 + static_cast<std::size_t>(seen.x);
        CHECK(int{read.points[point].color.r} == int{by.pixels.rgba[4 * pixel]});
        CHECK(int{read.points[point].color.b} == int{by.pixels.rgba[4 * pixel + 2]});
        return seen;
    };
    CHECK(check(0, known.train[0]).x == doctest::Approx(1));
    check(300, known.train[0]);
    CHECK(check(24 * 23, known.train[2]).x == doctest::Approx(25));  // the first certain column
    CHECK(read.train[2].depths.is_there());
    CHECK_FALSE(read.train[1].depths.is_there());

    // Held-out photos contribute no points.
    gs::load_options options = options_for(folder.path());
    options.eval = true;
    options.test_every = 4;
    CHECK(gs::load_scene(options, {}).points.size() == 24 * 11);
    gs_test::write_gray(folder / "keyframes/confidence/1002.png", 12, 48, confidence);
    CHECK(says(error_of([&] { load(folder.path()); }), {"confidence", "1002.png", "size"}));
}

TEST_CASE("polycam: malformed scenes are refused") {
    const temporary_folder folder;
    const json camera = write_scene(folder.path(), known_scene());
    const auto file = folder / "keyframes/cameras/1002.json";
    const auto error_with = [&](const char* field, const json& value) {
        json changed = camera;
        changed[field] = value;
        write_file(file, changed.dump());
        return error_of([&] { load(folder.path()); });
    };
    CHECK(error_with("unread", {{1}}).empty());
    CHECK(says(error_with("fx", "wide"), {"1002.json", "fx is not a number"}));
    CHECK(says(error_with("fx", {1}), {"1002.json", "fx is not a number"}));
    CHECK(says(error_with("fx", -1), {"1002.json", "focal length"}));
    CHECK(says(error_with("width", 0), {"1002.json", "width is 0", "whole number"}));
    CHECK(says(error_with("t_00", 9), {"1002.json", "not a rotation"}));
    CHECK(says(error_with("t_03", 1e300), {"1002.json", "position", "1e30"}));
    for (const char* field : {"fx", "cy", "height", "t_21"}) {
        json changed = camera;
        changed.erase(field);
        write_file(file, changed.dump());
        CHECK(says(error_of([&] { load(folder.path()); }), {"1002.json", field, "missing"}));
    }
    for (const char* content : {"[]", "3", "", "{\"fx\":NaN}"}) {
        write_file(file, content);
        CHECK(says(error_of([&] { load(folder.path()); }), {"1002.json"}));
    }
    write_file(file, camera.dump());
    std::filesystem::remove(folder / "keyframes/images/1002.png");
    CHECK(says(error_of([&] { load(folder.path()); }), {"1002.json", "photo", "missing"}));
    std::filesystem::remove_all(folder / "keyframes/images");
    CHECK(says(error_of([&] { load(folder.path()); }), {"keyframes/images", "does not exist"}));
    std::filesystem::create_directories(folder / "keyframes/images");
    std::filesystem::remove_all(folder / "keyframes/cameras");
    std::filesystem::create_directories(folder / "keyframes/cameras");
    CHECK(says(error_of([&] { load(folder.path()); }), {"keyframes/cameras", "no .json"}));
}
