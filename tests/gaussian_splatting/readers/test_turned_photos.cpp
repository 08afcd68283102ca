// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "../image/make_images.hpp"
#include "image/image.hpp"
#include "readers/load_scene.hpp"

namespace {

using gs_test::error_of;
using gs_test::says;
using gs_test::temporary_folder;

/// A PNG whose first stored pixel is white and all others black, with an EXIF orientation.
std::string photo(int width, int height, unsigned orientation) {
    const temporary_folder folder;
    const auto count = static_cast<std::size_t>(width * height);
    std::vector<float> planes(3 * count, 0.0F);
    for (const std::size_t plane : {0, 1, 2}) planes[plane * count] = 1;
    gs::write_png(folder / "a.png", width, height, planes);
    return gs_test::png_with_exif(gs_test::read_file(folder / "a.png"), gs_test::exif(orientation));
}

/// A scene with one camera for photos p0.png, p1.png and so on.
struct scene_folder {
    temporary_folder folder;
    nlohmann::json file{{"fl_x", 50}, {"frames", nlohmann::json::array()}};
    std::vector<std::string> messages;

    void add(const std::string& bytes) {
        const std::string name = "p" + std::to_string(file["frames"].size()) + ".png";
        gs_test::write_file(folder / name, bytes);
        file["frames"].push_back(
            {{"file_path", name},
             {"transform_matrix", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 4}, {0, 0, 0, 1}}}});
    }

    /// The size of the cameras, which the file may omit.
    void set_size(int width, int height) {
        file["w"] = width;
        file["h"] = height;
    }

    gs::scene load() {
        gs_test::write_file(folder / "transforms_train.json", file.dump());
        gs::load_options options;
        options.data = folder.path().string();
        return gs::load_scene(options, [&](const std::string& line) { messages.push_back(line); });
    }

    bool reported(const std::string& words) const {
        for (const std::string& line : messages)
            if (line.find(words) != std::string::npos) return true;
        return false;
    }
};

bool is_white(const gs::view& from, int x, int y) {
    return from.pixels.rgba[4 * static_cast<std::size_t>(y * from.pixels.width + x)] == 255;
}

}  // namespace

TEST_CASE("a photo is turned if its camera has the size after the EXIF rotation") {
    scene_folder scene;
    scene.add(photo(12, 8, 6));
    scene.set_size(8, 12);
    const gs::view view = scene.load().train[0];
    CHECK(view.pixels.width == 8);
    CHECK(view.pixels.height == 12);
    CHECK(view.camera.width == 8);
    CHECK(view.camera.height == 12);
    CHECK(is_white(view, 7, 0));  // the top left pixel, a quarter turn clockwise
    CHECK(scene.reported("1 photo turned upright"));
}

TEST_CASE("a photo stays as it is stored if its camera has that size") {
    scene_folder scene;
    scene.add(photo(12, 8, 6));
    scene.set_size(12, 8);
    const gs::view view = scene.load().train[0];
    CHECK(view.camera.width == 12);
    CHECK(is_white(view, 0, 0));
    CHECK_FALSE(scene.reported("upright"));
}

TEST_CASE("without a size in the file, a camera has the size after the EXIF rotation") {
    scene_folder scene;
    scene.add(photo(12, 8, 8));
    const gs::view view = scene.load().train[0];
    CHECK(view.camera.width == 8);
    CHECK(view.camera.height == 12);
    CHECK(view.camera.cx == doctest::Approx(4));
    CHECK(is_white(view, 0, 11));
}

TEST_CASE("scaled copies are turned, too") {
    scene_folder scene;
    scene.add(photo(12, 8, 6));
    scene.set_size(80, 120);
    const gs::view view = scene.load().train[0];
    CHECK(view.camera.width == 8);
    CHECK(view.camera.fx == doctest::Approx(5));
    CHECK(is_white(view, 7, 0));
}

TEST_CASE("photos whose shape fits both ways follow the other photos of the scene") {
    for (const bool square : {false, true}) {
        CAPTURE(square);
        const std::string ambiguous = square ? photo(12, 12, 6) : photo(12, 8, 3);
        const auto first_pixel_after_turn = square ? std::pair{11, 0} : std::pair{11, 7};
        const auto with_size = [&](scene_folder& scene, int width, int height, const std::string& bytes) {
            scene.add(bytes);
            scene.file["frames"].back()["w"] = width;
            scene.file["frames"].back()["h"] = height;
        };
        const int height = square ? 12 : 8;
        scene_folder alone, among_turned, among_stored;
        with_size(alone, 12, height, ambiguous);
        CHECK(is_white(alone.load().train[0], 0, 0));
        with_size(among_turned, 12, height, ambiguous);
        with_size(among_turned, 8, 12, photo(12, 8, 6));
        const auto [x, y] = first_pixel_after_turn;
        CHECK(is_white(among_turned.load().train[0], x, y));
        CHECK(among_turned.reported("2 photos turned upright"));
        with_size(among_stored, 12, height, ambiguous);
        with_size(among_stored, 12, 8, photo(12, 8, 6));
        CHECK(is_white(among_stored.load().train[0], 0, 0));
    }
}

TEST_CASE("a photo that fits its camera in neither way is refused with both sizes") {
    scene_folder scene;
    scene.add(photo(12, 8, 6));
    scene.set_size(16, 9);
    CHECK(says(error_of([&] { scene.load(); }),
               {"p0.png", "12x8", "8x12 after the rotation in its EXIF data", "16x9", "use the photo"}));
}

TEST_CASE("a photo is found with the endings of all formats, in small and capital letters") {
    for (const char* ending : {".png", ".PNG", ".jpeg", ".webp", ".WEBP", ".heic", ".HEIC", ".avif"}) {
        CAPTURE(ending);
        scene_folder scene;
        scene.add(photo(12, 8, 1));
        std::filesystem::rename(scene.folder / "p0.png", scene.folder / ("other" + std::string(ending)));
        scene.file["frames"][0]["file_path"] = "other";
        CHECK(scene.load().train[0].name == "other" + std::string(ending));
    }
    scene_folder scene;
    scene.add(photo(12, 8, 1));
    scene.file["frames"][0]["file_path"] = "none";
    CHECK(says(error_of([&] { scene.load(); }), {"none", "missing", ".png", ".webp", ".avif"}));
}
