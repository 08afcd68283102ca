// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "../../support/temporary_folder.hpp"
#include "known_scene.hpp"

namespace {

using gs_test::check_points;
using gs_test::check_views;
using gs_test::error_of;
using gs_test::known_panoramas;
using gs_test::known_scene;
using gs_test::load;
using gs_test::options_for;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;
using nlohmann::json;

json list_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

std::string photo_name(std::size_t i) { return "IMG_" + std::to_string(i) + ".png"; }

json camera_json(const gs::camera& c) {
    const double longer = std::max(c.width, c.height);
    return {{"projection_type", "brown"},
            {"width", c.width},
            {"height", c.height},
            {"focal_x", c.fx / longer},
            {"focal_y", c.fy / longer},
            {"c_x", (c.cx - 0.5 * c.width) / longer},
            {"c_y", (c.cy - 0.5 * c.height) / longer},
            {"k1", 0}};
}

json reconstruction_of(const gs::scene& known) {
    json result = {{"cameras", {{"v2 unknown 48 48 brown", camera_json(known.train[0].camera)}}},
                   {"shots", json::object()},
                   {"points", json::object()},
                   {"reference_lla", {{"latitude", 0}}}};
    for (std::size_t i = 0; i < known.train.size(); ++i) {
        const gs::camera& c = known.train[i].camera;
        const glm::dquat turn = glm::normalize(glm::quat_cast(c.rotation));
        result["shots"][photo_name(i)] = {{"rotation", list_of(glm::angle(turn) * glm::axis(turn))},
                                          {"translation", list_of(c.translation)},
                                          {"camera", "v2 unknown 48 48 brown"},
                                          {"orientation", 1},
                                          {"covariance", {{1, 2}, {3, 4}}}};
    }
    for (std::size_t i = 0; i < known.points.size(); ++i) {
        const glm::u8vec3 color = known.points[i].color;
        result["points"][std::to_string(1000 + i)] = {{"coordinates", list_of(known.points[i].position)},
                                                      {"color", {color.r, color.g, color.b}}};
    }
    return result;
}

void write_photos(const std::filesystem::path& folder, const gs::scene& known) {
    for (std::size_t i = 0; i < known.train.size(); ++i)
        gs_test::write_photo(folder / photo_name(i), known.train[i].pixels);
}

void write_json(const std::filesystem::path& file, const json& content) { write_file(file, content.dump()); }

}  // namespace

TEST_CASE("opensfm: a scene is read as it was written") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_json(folder / "reconstruction.json", json::array({reconstruction_of(known)}));
    write_photos(folder / "images", known);
    const gs::scene read = load(folder.path());
    check_views(read, known);
    check_points(read, known);
    CHECK(read.train[1].name == "IMG_1.png");
}

TEST_CASE("opensfm: ODM has the reconstruction in a subfolder, and photos may be listed") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_json(folder / "opensfm/reconstruction.json", json::array({reconstruction_of(known)}));
    write_photos(folder / "images", known);
    check_views(load(folder.path()), known);
    std::filesystem::rename(folder / "images", folder / "elsewhere");
    CHECK(says(error_of([&] { load(folder.path()); }), {"IMG_0.png", "images", "image_list.txt"}));
    std::string list = "../elsewhere/IMG_0.png\r\n" + (folder / "elsewhere/IMG_1.png").string() + "\n\n";
    write_file(folder / "opensfm/image_list.txt", list + "../elsewhere/IMG_2.png\n../elsewhere/IMG_3.png");
    check_views(load(folder.path()), known);
    gs::load_options options = options_for(folder.path());
    options.images = "elsewhere";
    options.eval = true;
    options.test_every = 2;
    std::filesystem::remove(folder / "opensfm/image_list.txt");
    CHECK(gs::load_scene(options, {}).test.size() == 2);
}

TEST_CASE("opensfm: of several reconstructions, the one with the most photos is used") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    json small = reconstruction_of(known);
    small["shots"].erase("IMG_1.png");
    write_json(folder / "reconstruction.json", json::array({small, reconstruction_of(known), small}));
    write_photos(folder / "images", known);
    std::string said;
    const gs::scene read =
        gs::load_scene(options_for(folder.path()), [&](const std::string& line) { said += line; });
    CHECK(read.train.size() == 4);
    CHECK(says(said, {"3 reconstructions", "largest, with 4 photos"}));
}

TEST_CASE("opensfm: each projection gives its camera") {
    const temporary_folder folder;
    gs::scene known = known_scene();
    known.train.resize(1);
    for (const std::string projection :
         {"perspective", "simple_radial", "radial", "brown", "fisheye", "fisheye_opencv"}) {
        CAPTURE(projection);
        json file = reconstruction_of(known);
        json& camera = file["cameras"].front();
        const bool one_focal_length = projection == "perspective" || projection == "fisheye";
        if (one_focal_length)
            camera = {{"width", 96}, {"height", 48}, {"focal", 0.5}};
        else
            camera = {{"width", 96},  {"height", 48},  {"focal_x", 0.5},
                      {"focal_y", 1}, {"c_x", 0.0625}, {"c_y", -0.125}};
        camera["projection_type"] = projection;
        write_json(folder / "reconstruction.json", json::array({file}));
        gs::image wide{96, 48, std::vector<std::uint8_t>(4 * 96 * 48, 255)};
        gs_test::write_photo(folder / "images/IMG_0.png", wide);
        const gs::camera plain = load(folder.path()).train[0].camera;
        CHECK(plain.fx == 48);
        CHECK(plain.fy == (one_focal_length ? 48 : 96));
        CHECK(plain.cx == (one_focal_length ? 48 : 54));
        CHECK(plain.cy == (one_focal_length ? 24 : 12));
        CHECK(plain.fisheye.has_value() == projection.starts_with("fisheye"));
        // Barrel distortion: the pinhole camera that shows no more than the photo is wider.
        camera["k1"] = -0.01;
        write_json(folder / "reconstruction.json", json::array({file}));
        const gs::camera bent = load(folder.path()).train[0].camera;
        if (plain.fisheye)
            CHECK(bent.fisheye.value().k()[0] == -0.01);
        else
            CHECK(bent.fx != plain.fx);
    }
}

TEST_CASE("opensfm: panoramas need no focal length") {
    const temporary_folder folder;
    const gs::scene known = known_panoramas();
    for (const char* projection : {"spherical", "equirectangular"}) {
        CAPTURE(projection);
        json file = reconstruction_of(known);
        file["cameras"].front() = {{"projection_type", projection},
                                   {"width", known.train[0].camera.width},
                                   {"height", known.train[0].camera.height}};
        write_json(folder / "reconstruction.json", json::array({file}));
        write_photos(folder / "images", known);
        const gs::scene read = load(folder.path());
        CHECK(read.train[0].camera.is_panorama);
        check_views(read, known);
    }
}

TEST_CASE("opensfm: masks and depth maps lie beside the photos") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_json(folder / "reconstruction.json", json::array({reconstruction_of(known)}));
    write_photos(folder / "images", known);
    gs::image mask{48, 48, std::vector<std::uint8_t>(4 * 48 * 48, 255)};
    std::fill_n(mask.rgba.begin(), 3, std::uint8_t{0});
    gs_test::write_photo(folder / "masks/IMG_2.png.png", mask);
    gs_test::write_gray(folder / "depths/IMG_2.png", 48, 48, std::vector<std::uint16_t>(48 * 48, 9));
    const gs::scene read = load(folder.path());
    CHECK(read.train[2].pixels.is_masked(0));
    CHECK(read.train[2].depths.values[1] == 9);
    CHECK_FALSE(read.train[1].depths.is_there());
}

TEST_CASE("opensfm: malformed reconstructions are refused") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_photos(folder / "images", known);
    const auto error_with = [&](const std::function<void(json&)>& change) {
        json file = json::array({reconstruction_of(known)});
        change(file);
        write_json(folder / "reconstruction.json", file);
        return error_of([&] { load(folder.path()); });
    };
    const auto error_of_shot = [&](const char* field, const json& value) {
        return error_with([&](json& f) { f[0]["shots"]["IMG_1.png"][field] = value; });
    };
    const auto error_of_camera = [&](const char* field, const json& value) {
        return error_with([&](json& f) { f[0]["cameras"].front()[field] = value; });
    };
    const auto error_of_point = [&](const char* field, const json& value) {
        return error_with([&](json& f) { f[0]["points"]["1001"][field] = value; });
    };
    CHECK(error_with([](json&) {}).empty());
    CHECK(error_with([](json& f) { f[0].erase("points"); }).empty());
    CHECK(says(error_with([](json& f) { f = json::object(); }), {"not a JSON array"}));
    CHECK(says(error_with([](json& f) { f = 3; }), {"not a JSON array"}));
    CHECK(says(error_with([](json& f) { f = json::array(); }), {"no shots"}));
    CHECK(says(error_with([](json& f) { f[0] = 3; }), {"reconstruction 0 is not a JSON object"}));
    CHECK(says(error_with([](json& f) { f[0] = json::array(); }), {"reconstruction 0 is not"}));
    CHECK(says(error_with([](json& f) { f[0]["shots"] = json::array(); }), {"shots is not a JSON object"}));
    CHECK(says(error_with([](json& f) { f[0]["points"] = "x"; }), {"points is not a JSON object"}));
    CHECK(says(error_with([](json& f) { f[0]["shots"]["IMG_1.png"] = 3; }), {"shot IMG_1.png is not"}));
    CHECK(says(error_with([](json& f) { f[0]["cameras"].clear(); }), {"shot IMG_0.png", "does not exist"}));
    CHECK(says(error_of_shot("camera", "none"), {"shot IMG_1.png", "camera none does not exist"}));
    CHECK(says(error_of_shot("camera", 3), {"shot IMG_1.png", "camera is not a string"}));
    CHECK(says(error_of_shot("rotation", {1, 2}), {"shot IMG_1.png", "rotation", "three finite numbers"}));
    CHECK(says(error_of_shot("rotation", {1, 2, 3, 4}), {"rotation", "three finite numbers"}));
    CHECK(says(error_of_shot("rotation", {1, 2, {3}}), {"rotation", "three finite numbers"}));
    CHECK(says(error_of_shot("rotation", 1), {"rotation", "three finite numbers"}));
    CHECK(says(error_of_shot("rotation", {1e9, 0, 0}), {"rotation", "1e6"}));
    CHECK(says(error_of_shot("translation", {{"x", 1}}), {"translation", "three finite numbers"}));
    CHECK(says(error_of_shot("translation", {1e200, 0, 0}), {"translation", "1e30"}));
    CHECK(says(error_of_camera("projection_type", "spherical"),
               {"camera v2 unknown", "panorama", "twice as wide as high", "48x48"}));
    CHECK(says(error_of_camera("projection_type", "dual"), {"dual is unknown", "fisheye_opencv"}));
    CHECK(says(error_of_camera("width", 0.5), {"width is 0.5", "whole number"}));
    CHECK(says(error_of_camera("height", 1e9), {"height is 1", "whole number"}));
    CHECK(says(error_of_camera("focal_x", 0), {"focal length"}));
    CHECK(says(error_of_camera("k1", "none"), {"k1 is not a finite number"}));
    CHECK(says(error_of_point("coordinates", {0, 1e31, 0}), {"point 1001", "1e30"}));
    CHECK(says(error_of_point("color", {0, nullptr, 0}), {"point 1001", "color"}));
    for (const char* field : {"rotation", "translation", "camera"})
        CHECK(says(error_with([&](json& f) { f[0]["shots"]["IMG_2.png"].erase(field); }),
                   {"shot IMG_2.png", field, "missing"}));
    for (const char* field : {"projection_type", "width", "height", "focal_x", "focal_y"})
        CHECK(says(error_with([&](json& f) { f[0]["cameras"].front().erase(field); }),
                   {"camera v2 unknown", field, "missing"}));
    std::filesystem::remove(folder / "images/IMG_3.png");
    CHECK(says(error_with([](json&) {}), {"IMG_3.png", "neither in"}));
    write_file(folder / "reconstruction.json",
               "[{\"shots\":{\"a\":{\"rotation\":[NaN,0,0],\"translation\":[0,0,0],"
               "\"camera\":\"c\"}}}]");
    CHECK(says(error_of([&] { load(folder.path()); }), {"shot a", "rotation", "finite"}));
    write_file(folder / "reconstruction.json", "[{\"shots\":{\"a\":{");
    CHECK(says(error_of([&] { load(folder.path()); }), {"reconstruction.json", "not valid JSON", "line 1"}));
}
