// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "colmap_model.hpp"
#include "readers/colmap/colmap.hpp"
#include "readers/colmap/write_colmap_model.hpp"
#include "scene/normalization.hpp"

using namespace gs_test;

namespace {

/// Cameras of all lenses, of which each takes a photo.
model_record all_lenses() {
    model_record model = plain_model();
    model.cameras = {
        {1, 1, "PINHOLE", 40, 30, {50, 35, 19, 16}},
        {2, 4, "OPENCV", 40, 30, {50, 48, 19, 16, -0.02, 0.01, 0.001, -0.002}},
        {3, 6, "FULL_OPENCV", 40, 30, {50, 48, 19, 16, -0.02, 0.01, 0.001, -0.002, 0.003, 0, 0, 0}},
        {4, 5, "OPENCV_FISHEYE", 40, 30, {12, 11, 19, 16, 0.1, -0.02, 0.003, -0.0004}}};
    model.images.push_back({{0.6, 0, 0.8, 0}, {4, 5, 6}, 1, "d.png", {}});
    for (std::uint32_t i = 0; i < 4; ++i) model.images[i].camera_id = i + 1;
    return model;
}

gs::scene load_normalized(const std::filesystem::path& folder, bool holds_out) {
    gs::load_options options = options_for(folder);
    options.eval = holds_out;
    options.resolution = 2;
    gs::scene scene = gs::load_scene(options, ignore);
    gs::normalize(scene, ignore);
    return scene;
}

const gs::colmap_image& image_named(const gs::colmap_model& model, const std::string& name) {
    return *std::ranges::find_if(model.images, [&](const auto& i) { return model.name(i) == name; });
}

}  // namespace

TEST_CASE("a written COLMAP model has the cameras, poses and points of the model that was loaded") {
    const temporary_folder folder;
    write_binary(folder / "sparse/0", all_lenses());
    write_photos(folder / "images", all_lenses(), 40, 30);
    for (const bool holds_out : {false, true}) {
        CAPTURE(holds_out);
        const gs::scene scene = load_normalized(folder.path(), holds_out);
        REQUIRE(scene.test.empty() != holds_out);
        gs::require_colmap_cameras(scene);
        gs::write_colmap_model(folder / "written", scene,
                               [&](std::size_t view) { return scene.train[view].camera; });

        const gs::colmap_model was = gs::read_colmap_model(folder / "sparse/0");
        const gs::colmap_model is = gs::read_colmap_model(folder / "written");
        REQUIRE(is.cameras.size() == 4);
        REQUIRE(is.images.size() == 4);
        for (const auto& image : was.images) {
            const auto& same = image_named(is, was.name(image));
            const glm::dquat turn = same.rotation * glm::conjugate(image.rotation);  // or its negative
            CHECK(glm::length(glm::dvec3(turn.x, turn.y, turn.z)) < rounding);
            CHECK(glm::distance(same.translation, image.translation) < rounding);
            const auto find_camera = [](const gs::colmap_model& of, std::uint32_t id) {
                return *std::ranges::find(of.cameras, id, &gs::colmap_camera::id);
            };
            const gs::colmap_camera a = find_camera(was, image.camera_id),
                                    b = find_camera(is, same.camera_id);
            CHECK(a.model_id == b.model_id);
            CHECK(std::array{a.fx, a.fy, a.cx, a.cy} == std::array{b.fx, b.fy, b.cx, b.cy});
            CHECK(a.coefficients == b.coefficients);
            CHECK(a.k3 == b.k3);
            CHECK(std::pair{a.width, a.height} == std::pair{b.width, b.height});
        }
        REQUIRE(is.points.size() == was.points.size());
        for (std::size_t i = 0; i < is.points.size(); ++i) {
            CHECK(glm::distance(is.points[i].position, was.points[i].position) < rounding);
            CHECK(is.points[i].color == was.points[i].color);
        }
    }
}

TEST_CASE("a written COLMAP model has the learned poses, and the given ones of held-out views") {
    const temporary_folder folder;
    write_binary(folder / "sparse/0", all_lenses());
    write_photos(folder / "images", all_lenses(), 40, 30);
    const gs::scene scene = load_normalized(folder.path(), true);
    const glm::dvec3 apart(0.5, -1, 2);
    gs::write_colmap_model(folder / "written", scene, [&](std::size_t view) {
        gs::camera moved = scene.train[view].camera;
        moved.translation -= moved.rotation * (apart / scene.normalization.scale);
        return moved;
    });
    const gs::colmap_model was = gs::read_colmap_model(folder / "sparse/0");
    const gs::colmap_model is = gs::read_colmap_model(folder / "written");
    const auto center = [](const gs::colmap_image& i) {
        return -(glm::conjugate(i.rotation) * i.translation);
    };
    for (const auto& image : was.images) {
        const std::string name = was.name(image);
        CAPTURE(name);
        const bool is_held_out =
            std::ranges::any_of(scene.test, [&](const gs::view& v) { return v.name == name; });
        CHECK(glm::distance(center(image_named(is, name)),
                            center(image) + (is_held_out ? glm::dvec3(0) : apart)) < 1e-11);
    }
}

TEST_CASE("COLMAP models: photos by one lens share a camera") {
    const temporary_folder folder;
    const model_record model = photos_by({1, 1, "PINHOLE", 40, 30, {50, 35, 19, 16}}, {"a.png", "b.png"});
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 30);
    const gs::scene scene = load_normalized(folder.path(), false);
    gs::write_colmap_model(folder / "written", scene,
                           [&](std::size_t view) { return scene.train[view].camera; });
    CHECK(gs::read_colmap_model(folder / "written").cameras.size() == 1);
}

TEST_CASE("COLMAP models: panoramas are refused, and so are the coefficients k4 to k6") {
    CHECK(says(error_of([] { gs::require_colmap_cameras(known_panoramas()); }),
               {"panoramas", "--save-cameras"}));
    const temporary_folder folder;
    model_record model = photos_by({1, 6, "FULL_OPENCV", 40, 30, {50, 48, 19, 16, 0, 0, 0, 0, 0, 0, 0.1, 0}},
                                   {"a.png", "b.png"});
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 30);
    CHECK(
        says(error_of_loading(folder.path()), {"cameras.bin", "camera 1", "k4 to k6", "image_undistorter"}));
}
