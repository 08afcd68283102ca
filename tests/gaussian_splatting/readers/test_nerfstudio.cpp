// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <functional>
#include <glm/matrix.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../../support/temporary_folder.hpp"
#include "known_scene.hpp"
#include "readers/point_cloud.hpp"

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

json matrix_of(const gs::camera& c) {
    const glm::dmat3 axes = glm::transpose(c.rotation);
    const glm::dvec3 center = c.center();
    json rows = json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back({axes[0][row], -axes[1][row], -axes[2][row], center[row]});
    rows.push_back({0, 0, 0, 1});
    return rows;
}

json frame_of(const gs::view& one, const std::string& path) {
    const gs::camera& c = one.camera;
    return {{"file_path", path}, {"transform_matrix", matrix_of(c)},
            {"fl_x", c.fx},      {"fl_y", c.fy},
            {"cx", c.cx},        {"cy", c.cy},
            {"w", c.width},      {"h", c.height}};
}

std::string text_cloud(const std::vector<gs::colored_point>& points) {
    std::ostringstream out;
    out.precision(9);
    out << "ply\nformat ascii 1.0\ncomment a comment\nelement vertex " << points.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nproperty uint8 red\n"
           "property uint8 green\nproperty uint8 blue\nend_header\n";
    for (const auto& [p, c] : points)
        out << p.x << ' ' << p.y << ' ' << p.z << ' ' << int{c.r} << ' ' << int{c.g} << ' ' << int{c.b}
            << '\n';
    return out.str();
}

template <class T>
std::string raw(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Positions in double precision, between properties that are not used, and colors as floats.
std::string binary_cloud(const std::vector<gs::colored_point>& points) {
    std::string text =
        "ply\r\nformat binary_little_endian 1.0\r\nelement vertex " + std::to_string(points.size()) +
        "\r\nproperty uchar before\r\nproperty double z\r\nproperty double y\r\nproperty short "
        "between\r\nproperty double x\r\nproperty float blue\r\nproperty float green\r\nproperty "
        "float red\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\nend_header\n";
    for (const auto& [p, c] : points)
        text += raw(std::uint8_t{7}) + raw(p.z) + raw(p.y) + raw(std::int16_t{-1}) + raw(p.x) +
                raw(static_cast<float>(c.b) / 255) + raw(static_cast<float>(c.g) / 255) +
                raw(static_cast<float>(c.r) / 255);
    return text + raw(std::uint8_t{0});
}

/// Writes the scene with intrinsics in each frame, and returns the content of transforms.json.
json write_scene(const std::filesystem::path& folder, const gs::scene& known) {
    json file = {{"camera_model", "OPENCV"},
                 {"ply_file_path", "sparse_pc.ply"},
                 {"applied_transform", {{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}}},
                 {"frames", json::array()}};
    for (std::size_t i = 0; i < known.train.size(); ++i) {
        const std::string path = "images/frame_0" + std::to_string(i) + ".png";
        gs_test::write_photo(folder / path, known.train[i].pixels);
        file["frames"].push_back(frame_of(known.train[i], path));
    }
    write_file(folder / "sparse_pc.ply", text_cloud(known.points));
    write_file(folder / "transforms.json", file.dump());
    return file;
}

std::string error_of_cloud(const std::string& content) {
    const temporary_folder folder;
    write_file(folder / "points.ply", content);
    return error_of([&] { gs::read_point_cloud(folder / "points.ply"); });
}

}  // namespace

TEST_CASE("nerfstudio: a scene is read as it was written, with the points in the coordinates of the frames") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    write_scene(folder.path(), known);
    const gs::scene read = load(folder.path());
    check_views(read, known);
    check_points(read, known);
    CHECK_FALSE(read.object_centered);
    write_file(folder / "sparse_pc.ply", binary_cloud(known.points));
    check_points(load(folder.path()), known);
}

TEST_CASE("nerfstudio: without a point file, the scene has no points") {
    const temporary_folder folder;
    json file = write_scene(folder.path(), known_scene());
    file.erase("ply_file_path");
    write_file(folder / "transforms.json", file.dump());
    std::string said;
    CHECK(gs::load_scene(options_for(folder.path()), [&](const std::string& line) {
              said += line;
          }).points.empty());
    CHECK(says(said, {"no points"}));
}

TEST_CASE("nerfstudio: intrinsics of a frame override those of the file") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    json file = write_scene(folder.path(), known);
    file.update({{"fl_x", 10}, {"fl_y", 11}, {"cx", 12}, {"cy", 13}, {"w", 24}, {"h", 24}});
    for (const char* name : {"fl_x", "fl_y", "cx", "cy", "w", "h"}) file["frames"][2].erase(name);
    file["frames"][2]["camera_model"] = "SIMPLE_PINHOLE";
    file["frames"][3].update({{"camera_model", "OPENCV_FISHEYE"}, {"k1", 0.01}});
    write_file(folder / "transforms.json", file.dump());
    const gs::scene read = load(folder.path());
    const gs::camera& doubled = read.train[2].camera;  // the photo is twice as large as w and h
    CHECK(std::array{doubled.fx, doubled.fy, doubled.cx, doubled.cy} == std::array{20.0, 22.0, 24.0, 26.0});
    CHECK(read.train[1].camera.fx == known.train[1].camera.fx);
    CHECK(read.train[3].camera.fisheye.value().k()[0] == 0.01);
    CHECK_FALSE(doubled.fisheye);
}

TEST_CASE("nerfstudio: panoramas, for which intrinsics in the file do not count") {
    const temporary_folder folder;
    const gs::scene known = known_panoramas();
    json file = write_scene(folder.path(), known);
    file["camera_model"] = "EQUIRECTANGULAR";
    file.update({{"k1", 0.3}, {"k4", 0.1}});
    for (const char* name : {"fl_x", "fl_y", "cx"}) file["frames"][0].erase(name);
    for (const char* name : {"w", "h"}) file["frames"][1].erase(name);
    file["frames"][2].update({{"w", 2000}, {"h", 1000}});  // the photo is a smaller copy
    write_file(folder / "transforms.json", file.dump());
    const gs::scene read = load(folder.path());
    check_views(read, known);
    check_points(read, known);
    for (const gs::view& v : read.train) CHECK(v.camera.is_panorama);
    file["frames"][3]["camera_model"] = "PINHOLE";
    for (const char* name : {"k1", "k4"}) file.erase(name);
    write_file(folder / "transforms.json", file.dump());
    CHECK_FALSE(load(folder.path()).train[3].camera.is_panorama);
}

TEST_CASE("nerfstudio: a third radial coefficient is removed from the photos") {
    const temporary_folder folder;
    json file = write_scene(folder.path(), known_scene());
    file["frames"][0]["k3"] = 0.3;
    write_file(folder / "transforms.json", file.dump());
    const gs::scene read = load(folder.path());
    CHECK(read.train[0].camera.fx > read.train[1].camera.fx);  // pincushion: a narrower view
    const gs::lens third{0, 0, 0, 0, 0.3};
    CHECK(third.distort({0.5, 0}).x == doctest::Approx(0.5 * (1 + 0.3 * std::pow(0.5, 6))));
    // The scale of areas is the radial derivative times the tangential scale.
    const double r = 0.7, step = 1e-6;
    const double slope = (third.distort({r + step, 0}).x - third.distort({r - step, 0}).x) / (2 * step);
    CHECK(third.area_scale({r, 0}) == doctest::Approx(slope * third.distort({r, 0}).x / r));
}

TEST_CASE("nerfstudio: every n-th photo is held out, but not in a Blender scene") {
    const temporary_folder folder;
    write_scene(folder.path(), known_scene());
    gs::load_options options = options_for(folder.path());
    options.eval = true;
    options.test_every = 3;
    const gs::scene read = gs::load_scene(options, {});
    REQUIRE(read.test.size() == 2);
    CHECK(read.test[1].name == "images/frame_03.png");
    CHECK(read.train.size() == 2);
    std::filesystem::rename(folder / "transforms.json", folder / "transforms_train.json");
    CHECK(says(error_of([&] { gs::load_scene(options, {}); }), {"--test-every", "Blender", "nerfstudio"}));
    CHECK(load(folder.path()).points.size() == 40);
}

TEST_CASE("nerfstudio: depth maps hold depths, so the nearest pixel gets the largest inverse depth") {
    const temporary_folder folder;
    const gs::scene known = known_scene();
    json file = write_scene(folder.path(), known);
    file["frames"][1]["depth_file_path"] = "depth/frame.png";
    write_file(folder / "transforms.json", file.dump());
    CHECK(says(error_of([&] { load(folder.path()); }), {"frame 1", "depth map", "does not exist"}));
    // Depths of 1, 2 and 4 meters in millimeters, and an unknown one, in four columns of the photo.
    std::vector<std::uint16_t> depths;
    for (int y = 0; y < 48; ++y)
        for (const int depth : {1000, 2000, 4000, 0})
            depths.insert(depths.end(), 12, static_cast<std::uint16_t>(depth));

    gs_test::write_gray(folder / "depth/frame.png", 48, 48, depths);
    const gs::depth_map read = load(folder.path()).train[1].depths;
    REQUIRE(read.width == 48);
    const std::vector<int> columns{read.values[5], read.values[17], read.values[29], read.values[41]};
    CHECK(columns == std::vector<int>{65535, 32768, 16384, 0});
    gs::load_options options = options_for(folder.path());
    options.depths = false;
    CHECK_FALSE(gs::load_scene(options, {}).train[1].depths.is_there());
}

TEST_CASE("nerfstudio: files that cannot be used") {
    const temporary_folder folder;
    const json file = write_scene(folder.path(), known_scene());
    const auto error_with = [&](const std::function<void(json&)>& change) {
        json changed = file;
        change(changed);
        write_file(folder / "transforms.json", changed.dump());
        return error_of([&] { load(folder.path()); });
    };
    CHECK(says(error_with([](json& f) { f["ply_file_path"] = "none.ply"; }),
               {"transforms.json", "ply_file_path", "none.ply", "does not exist"}));
    CHECK(says(error_with([](json& f) { f["ply_file_path"] = 3; }), {"ply_file_path is not a string"}));
    CHECK(says(error_with([](json& f) { f["ply_file_path"] = {3}; }), {"ply_file_path is not a string"}));
    CHECK(error_with([](json& f) { f["ply_file_path"] = nullptr; }).empty());
    CHECK(says(error_with([](json& f) { f["frames"][1]["depth_file_path"] = false; }),
               {"frame 1", "depth_file_path is not a string"}));
    CHECK(says(error_with([](json& f) { f["frames"][1]["camera_model"] = "EQUIRECTANGULAR"; }),
               {"transforms.json", "frame 1", "panorama", "twice as wide as high", "48x48"}));
    CHECK(says(error_with([](json& f) { f["frames"][1]["camera_model"] = "FISHEYE624"; }),
               {"frame 1", "FISHEYE624", "unknown"}));
}

TEST_CASE("point clouds: a cloud without colors is gray, and blank files are refused") {
    const temporary_folder folder;
    const auto file = folder / "points.ply";
    write_file(file,
               "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n1 2 3\n4 5 6");
    const auto points = gs::read_point_cloud(file);
    REQUIRE(points.size() == 2);
    CHECK(points[1].position == glm::dvec3(4, 5, 6));
    CHECK(points[1].color == glm::u8vec3(128));
    CHECK(says(error_of_cloud(""), {"points.ply", "not a PLY file"}));
    CHECK(says(error_of([&] { gs::read_point_cloud(folder / "none.ply"); }), {"none.ply"}));
}

TEST_CASE("point clouds: malformed files are refused") {
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const auto text = [](const std::string& header, const std::string& rows) {
        return error_of_cloud("ply\nformat ascii 1.0\nelement vertex 1\n" + header + "end_header\n" + rows);
    };
    const auto binary = [](const std::string& count, const std::string& header, const std::string& rows) {
        return error_of_cloud("ply\nformat binary_little_endian 1.0\nelement vertex " + count + "\n" +
                              header + "end_header\n" + rows);
    };
    const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    CHECK(text(xyz, "1 2 3\n").empty());
    CHECK(says(text(xyz, "1 2\n3\n"), {"vertex 0", "instead of a number"}));
    CHECK(says(text(xyz, "1 2 3 4\n"), {"vertex 0", "more than 3 values"}));
    CHECK(says(text(xyz, "1 2 nan\n"), {"vertex 0", "not finite"}));
    CHECK(says(text(xyz, "1 2 x\n"), {"vertex 0", "'x'"}));
    CHECK(says(text(xyz, ""), {"announces 1 vertices", "0 bytes"}));
    CHECK(says(text(xyz + colors, "1 2 3 4 5 256\n"), {"color of vertex 0", "0 to 255"}));
    CHECK(says(text(xyz + "property uchar red\n", "1 2 3 4\n"), {"red, green and blue"}));
    CHECK(says(text("property float x\nproperty float y\n", "1 2 3\n"), {"no property 'z'"}));
    CHECK(says(text("property int x\n" + xyz.substr(17), "1 2 3\n"), {"'x'", "neither float nor double"}));
    CHECK(says(text(xyz + "property float x\n", "1 2 3 4\n"), {"'x' twice"}));
    CHECK(says(text("property list uchar int x\n", "1 2 3\n"), {"list", "not a scalar type"}));
    CHECK(binary("1", xyz, std::string(12, '\0')).empty());
    CHECK(says(binary("18446744073709551615", xyz, std::string(12, '\0')), {"announces 1844"}));
    CHECK(says(binary("2", xyz, std::string(23, '\0')), {"announces 2 vertices", "23 bytes"}));
    CHECK(says(binary("-1", xyz, ""), {"count", "'-1'"}));
    CHECK(says(binary("1", xyz, raw(0.0F) + raw(0.0F) + raw(std::numeric_limits<float>::infinity())),
               {"vertex 0", "not finite"}));
    CHECK(says(error_of_cloud("ply\nformat binary_big_endian 1.0\n"), {"binary_big_endian"}));
    CHECK(says(error_of_cloud("ply\nformat ascii 1.0\nelement vertex 1\n"), {"no end_header"}));
    CHECK(says(error_of_cloud("ply\nelement face 1\n"), {"first element is 'face'"}));
}
