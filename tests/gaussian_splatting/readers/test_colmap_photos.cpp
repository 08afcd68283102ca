// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "image/mask.hpp"
#include "known_lenses.hpp"
#include "readers/colmap/colmap.hpp"
#include "scene/downsample.hpp"

using namespace gs_test;

TEST_CASE("the resolution scales photos and intrinsics by the same exact ratios") {
    const temporary_folder folder;
    model_record model = plain_model();
    model.cameras = {{1, 1, "PINHOLE", 101, 67, {120, 90, 49, 35}}};
    for (auto& i : model.images) i.camera_id = 1;
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 101, 67);
    const gs::scene full = gs::load_scene(options_for(folder.path()), ignore);
    struct expected {
        int resolution, width, height;
    };
    for (const expected& one : {expected{1, 101, 67},
                                {2, 51, 34},
                                {4, 25, 17},
                                {8, 13, 8},
                                {50, 50, 33},
                                {100, 100, 66},
                                {3, 3, 2},
                                {101, 101, 67},
                                {400, 101, 67}}) {
        const int resolution = one.resolution, width = one.width, height = one.height;
        CAPTURE(resolution);
        auto options = options_for(folder.path());
        options.resolution = resolution;
        std::string said;
        const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
        for (std::size_t i = 0; i < scene.train.size(); ++i) {
            const gs::camera& c = scene.train[i].camera;
            REQUIRE(c.width == width);
            REQUIRE(c.height == height);
            CHECK(scene.train[i].pixels.width == width);
            CHECK(scene.train[i].pixels.height == height);
            CHECK(c.fx == doctest::Approx(120.0 * width / 101).epsilon(rounding));
            CHECK(c.fy == doctest::Approx(90.0 * height / 67).epsilon(rounding));
            const glm::dvec3 point = glm::transpose(c.rotation) * (glm::dvec3(0.3, -0.2, 2) - c.translation);
            const glm::dvec2 at = project(c, point), was = project(full.train[i].camera, point);
            CHECK(at.x / width == doctest::Approx(was.x / 101).epsilon(rounding));
            CHECK(at.y / height == doctest::Approx(was.y / 67).epsilon(rounding));
        }
        if (resolution == 1 || resolution == 101)
            CHECK(said.empty());
        else if (resolution == 400)
            CHECK(says(said, {"3 photos left as they are", "400"}));
        else
            CHECK(says(said,
                       {"3 photos resized", "101x67", std::to_string(width) + "x" + std::to_string(height)}));
    }
    auto options = options_for(folder.path());
    options.resolution = 0;
    CHECK(says(error_of_loading(options), {"resolution", "at least 1"}));
}

TEST_CASE("a photo is never downsampled below one pixel") {
    const temporary_folder folder;
    model_record model = plain_model();
    for (auto& c : model.cameras) c.width = 40, c.height = 2;
    write_binary(folder / "sparse/0", model);
    write_photos(folder / "images", model, 40, 2);
    auto options = options_for(folder.path());
    options.resolution = 8;
    const gs::scene scene = gs::load_scene(options, ignore);
    CHECK(scene.train[0].pixels.width == 5);
    CHECK(scene.train[0].pixels.height == 1);
}

TEST_CASE("smaller copies of the photos take their cameras along, and other sizes are wrong") {
    const temporary_folder folder;
    write_scene(folder.path());
    write_photos(folder / "images_2", plain_model(), 20, 15);
    auto options = options_for(folder.path());
    options.images = "images_2";
    std::string said;
    const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
    const gs::camera& c = scene.train[0].camera;
    CHECK(std::array{c.fx, c.fy, c.cx, c.cy} == std::array{25.0, 17.5, 9.5, 8.0});
    CHECK(std::pair{c.width, c.height} == std::pair{20, 15});
    CHECK(says(said, {"3 photos", "40x30", "20x15", "scaled"}));

    write_photos(folder / "images_3", plain_model(), 400, 300);
    options.images = "images_3";
    write_photo(folder / "images_3/b.png", 400, 304);  // 1.3 % off
    CHECK(says(error_of_loading(options), {"b.png", "wrong size", "400x304", "40x30"}));
    write_photo(folder / "images_3/b.png", 400, 302);  // 0.7 % off
    CHECK(error_of_loading(options).empty());
    write_photo(folder / "images_3/b.png", 200, 150);  // a smaller copy, but the only one
    CHECK(says(error_of_loading(options), {"b.png", "wrong size", "200x150", "40x30"}));
}

TEST_CASE("masks exclude black pixels, also in undistorted and downsampled photos") {
    for (const double bent : {0.0, 0.1}) {
        CAPTURE(bent);
        const distorted_case lens = radial(-bent, bent / 2);
        const gs::camera c = intrinsics_of(lens.camera);
        const temporary_folder folder;
        write_binary(folder / "sparse/0", photos_by(lens.camera, {"a.png", "b/c.png", "d.png"}));
        // Photos are red where the mask is black, and blue otherwise; the masks are 1 of 255 where they are
        // not black.
        const auto write = [&](const std::filesystem::path& file, const std::array<float, 3>& left_out,
                               const std::array<float, 3>& kept) {
            std::filesystem::create_directories(file.parent_path());
            std::vector<float> planes;
            for (std::size_t plane = 0; plane < 3; ++plane)
                for (int y = 0; y < c.height; ++y)
                    for (int x = 0; x < c.width; ++x)
                        planes.push_back((x < c.width / 3 ? left_out : kept)[plane]);
            gs::write_png(file, c.width, c.height, planes);
        };
        for (const char* name : {"images/a.png", "images/b/c.png", "images/d.png"})
            write(folder / name, {1, 0, 0}, {0, 0, 1});
        for (const char* name : {"masks/a.png.png", "masks/b/c.png"})
            write(folder / name, {0, 0, 0}, {0, 1.0f / 255, 0});
        auto options = options_for(folder.path());
        for (const int resolution : {1, 2, 4}) {
            CAPTURE(resolution);
            options.resolution = resolution;
            options.masks = true;
            std::string said;
            const gs::scene scene = gs::load_scene(options, [&](const std::string& line) { said += line; });
            CHECK(says(said, {"2 photos of 3 have masks"}));
            CHECK_FALSE(scene.has_alpha);
            options.masks = false;
            const gs::scene whole = gs::load_scene(options, ignore);
            for (std::size_t v = 0; v < 3; ++v) {
                const gs::image &pixels = scene.train[v].pixels, &all = whole.train[v].pixels;
                CHECK(pixels.has_mask == (v < 2));
                CHECK_FALSE(all.has_mask);
                for (std::size_t i = 0; i < all.rgba.size() / 4; ++i) {
                    const int red = all.rgba[4 * i];
                    if (v < 2 && red > 200) CHECK(pixels.is_masked(i));
                    if (v == 2 || red < 60) CHECK_FALSE(pixels.is_masked(i));
                    // What is left out comes into no average, but into what bending interpolates.
                    if (v < 2 && !pixels.is_masked(i)) CHECK(pixels.rgba[4 * i] <= (bent > 0 ? 128 : 0));
                }
            }
        }
        options.masks = true;
        options.resolution = 1;
        write(folder / "masks/a.png.png", {0, 0, 0}, {0, 0, 0});
        CHECK(says(error_of_loading(options), {"a.png.png", "leaves nothing"}));
        write_photo(folder / "masks/a.png.png", 30, 22);
        CHECK(says(error_of_loading(options), {"a.png.png", "wrong size", "30x22"}));
        write_file(folder / "masks/a.png.png", "no mask");
        CHECK(says(error_of_loading(options), {"a.png.png"}));
    }
}

TEST_CASE("depth maps are undistorted and downsampled with their photos, and some photos have none") {
    for (const double bent : {0.0, 0.1}) {
        CAPTURE(bent);
        const distorted_case lens = radial(-bent, bent / 2);
        const gs::camera c = intrinsics_of(lens.camera);
        const temporary_folder folder;
        write_binary(folder / "sparse/0", photos_by(lens.camera, {"a.jpg", "b.png", "c.png"}));
        // Bright above, dark below, not known at the left; photos are as the maps.
        const auto write = [&](int width, int height) {
            std::vector<std::uint16_t> values;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    values.push_back(4 * x < width ? 0 : 2 * y < height ? 60000 : 257);
            write_gray(folder / "depths/a.png", width, height, values);
        };
        for (const char* name : {"a.jpg", "b.png", "c.png"}) {
            std::vector<float> planes;
            for (int plane = 0; plane < 3; ++plane)
                for (int y = 0; y < c.height; ++y)
                    for (int x = 0; x < c.width; ++x) planes.push_back(2 * y < c.height ? 1.0f : 0.0f);
            std::filesystem::create_directories(folder / "images");
            gs::write_png(folder / "images" / name, c.width, c.height, planes);
        }
        auto options = options_for(folder.path());
        for (const int smaller : {1, 3})
            for (const int resolution : {1, 2, 4}) {
                CAPTURE(smaller);
                CAPTURE(resolution);
                write(c.width / smaller, c.height / smaller);
                options.resolution = resolution;
                std::string said;
                const gs::scene scene =
                    gs::load_scene(options, [&](const std::string& line) { said += line; });
                CHECK(says(said, {"1 photo of 3 has a depth map"}));
                const gs::view& first = scene.train[0];
                REQUIRE(first.depths.is_there());
                CHECK_FALSE(scene.train[1].depths.is_there());
                CHECK(first.depths.width == first.pixels.width);
                REQUIRE(first.depths.values.size() == first.pixels.rgba.size() / 4);
                std::size_t wrong = 0, known = 0;
                for (std::size_t i = 0; i < first.depths.values.size(); ++i) {
                    const int value = first.depths.values[i], gray = first.pixels.rgba[4 * i];
                    known += value != 0;
                    if (value != 0 && (gray == 0 || gray == 255)) wrong += (value > 30000) != (gray > 127);
                }
                CHECK(wrong <= first.depths.values.size() / 20);  // where a map is coarser than its photo
                CHECK(static_cast<double>(known) / static_cast<double>(first.depths.values.size()) ==
                      doctest::Approx(0.75).epsilon(0.1));
                const gs::view half = gs::downsampled(first, 2);
                CHECK(half.depths.width == half.pixels.width);
                CHECK(half.depths.values.size() == half.pixels.rgba.size() / 4);
            }
        options.resolution = 1;
        options.depths = false;
        CHECK_FALSE(gs::load_scene(options, ignore).train[0].depths.is_there());
        options.depths = true;
        write(c.width, c.height / 2);
        CHECK(says(error_of_loading(options), {"depths/a.png", "another shape"}));
        gs::write_png(folder / "depths/a.png", 1, 1, {0, 0, 0});
        CHECK(says(error_of_loading(options), {"depths/a.png", "more than one channel"}));
        write_file(folder / "depths/a.png", "no map");
        CHECK(says(error_of_loading(options), {"depths/a.png"}));
    }
}

TEST_CASE("a mask leaves out of a depth map what it leaves out of its photo") {
    gs::image photo{2, 1, {9, 9, 9, 255, 9, 9, 9, 255}};
    photo.mask_pixel(1);
    gs::depth_map depths{2, 1, {7, 8}}, none;
    gs::clear_masked_depths(photo, depths);
    gs::clear_masked_depths(photo, none);
    CHECK(depths.values == std::vector<std::uint16_t>{7, 0});
    CHECK_FALSE(none.is_there());
}

TEST_CASE("a mask has its photo's name, in its own folder") {
    const temporary_folder folder;
    const auto masks = folder / "masks";
    for (const char* name : {"masks/x.jpg.png", "masks/x.png", "masks/sub/y.png", "images/z.png"}) {
        std::filesystem::create_directories((folder / name).parent_path());
        write_file(folder / name, "");
    }
    CHECK(gs::beside_photo(masks, "x.jpg") == masks / "x.jpg.png");
    CHECK(gs::beside_photo(masks, "x.JPG") == masks / "x.png");
    CHECK(gs::beside_photo(masks, "sub/y.jpeg") == masks / "sub/y.png");
    CHECK(gs::beside_photo(masks, "y.jpeg").empty());
    CHECK(gs::beside_photo(masks, "").empty());
    CHECK(gs::beside_photo(masks, "../images/z.png").empty());
    CHECK(gs::beside_photo(masks, (folder / "images/z.png").string()).empty());
}
