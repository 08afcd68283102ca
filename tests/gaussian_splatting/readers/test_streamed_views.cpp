// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "../image/write_jpeg.hpp"
#include "known_scene.hpp"
#include "readers/load_views.hpp"
#include "scene/view_photo.hpp"

namespace {

using gs_test::error_of;
using gs_test::says;
using gs_test::temporary_folder;

namespace fs = std::filesystem;

/// Records of a distorted photo with mask and depth map, and of a photo with a masked border.
std::vector<gs::image_record> records_in(const fs::path& folder) {
    const gs::scene known = gs_test::known_scene();
    std::vector<gs::image_record> records(2);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].name = "photo" + std::to_string(i) + ".png";
        records[i].camera = known.train[i].camera;
        records[i].file = folder / records[i].name;
        gs_test::write_photo(records[i].file, known.train[i].pixels);
    }
    const std::size_t pixels = 48 * 48;
    std::vector<float> half(3 * pixels, 1.0F);
    for (std::size_t k = 0; k < half.size(); ++k) half[k] = k % 48 < 20 ? 0.0F : 1.0F;
    std::vector<std::uint16_t> depths(pixels);
    for (std::size_t k = 0; k < pixels; ++k) depths[k] = static_cast<std::uint16_t>(100 + k);
    records[0].distortion = {0.1, 0.01, 0, 0, 0};
    records[0].camera_model = "OPENCV";
    records[0].mask = folder / "mask.png";
    records[0].depth = folder / "depth.png";
    gs::write_png(records[0].mask, 48, 48, half);
    gs_test::write_gray(records[0].depth, 48, 48, depths);
    records[1].masked_border = 3;
    return records;
}

}  // namespace

TEST_CASE("streamed views: photos are the same as those of resident views") {
    const temporary_folder folder;
    const auto records = records_in(folder.path());
    gs::load_options options;
    options.resolution = 2;
    const auto resident = gs::load_views(records, options, [](const std::string&) {});
    options.most_photo_bytes = 1000;
    const auto streamed = gs::load_views(records, options, [](const std::string&) {});
    CHECK(resident[0].pixels.has_mask);
    CHECK(resident[1].pixels.has_mask);
    CHECK(resident[0].depths.is_there());
    for (std::size_t i = 0; i < records.size(); ++i) {
        CAPTURE(i);
        CHECK_FALSE(resident[i].is_streamed());
        REQUIRE(streamed[i].is_streamed());
        CHECK(streamed[i].pixels.rgba.capacity() == 0);
        CHECK(streamed[i].depths.values.capacity() == 0);
        CHECK(streamed[i].depths.is_there() == resident[i].depths.is_there());
        CHECK(streamed[i].pixels.has_mask == resident[i].pixels.has_mask);
        CHECK(streamed[i].camera.fx == resident[i].camera.fx);
        for (int again = 0; again < 2; ++again) {
            const gs::view_photo photo(streamed[i]);
            CHECK(photo.pixels().rgba == resident[i].pixels.rgba);
            CHECK(photo.depths().values == resident[i].depths.values);
        }
    }
}

TEST_CASE("streamed views: a JPEG that is used as it is has samples that take less memory") {
    const temporary_folder folder;
    gs::image_record record;
    record.name = "photo.jpg";
    record.camera = gs_test::known_scene().train[0].camera;
    record.file = folder.path() / record.name;
    gs_test::write_jpeg(record.file, 48, 48, {JCS_RGB, false, false, false, 2, 2},
                        gs_test::smooth_samples(48, 48, 3));
    gs::load_options options;
    options.most_photo_bytes = 0;
    const auto streamed_view = [&](const gs::image_record& of) {
        return gs::load_views({of}, options, [](const std::string&) {}).front();
    };
    const gs::view view = streamed_view(record);
    CHECK(view.plane_bytes == 48 * 48 * 3 / 2);
    REQUIRE(view.read_planes);
    gs::jpeg_planes planes;
    view.read_planes(planes);
    const gs::view_photo decoded(view);
    std::vector<std::uint8_t> rgba(decoded.pixels().rgba.size());
    gs::to_rgba(planes, rgba.data());
    CHECK(rgba == decoded.pixels().rgba);

    gs::image_record changed = record;
    changed.masked_border = 3;
    CHECK_FALSE(streamed_view(changed).read_planes);
    changed = record;
    changed.distortion = {0.1, 0.01, 0, 0, 0};
    CHECK_FALSE(streamed_view(changed).read_planes);
    changed = record;
    changed.mask = folder.path() / "mask.png";
    std::vector<float> half(3 * 48 * 48, 1.0F);
    std::fill(half.begin(), half.begin() + 48, 0.0F);
    gs::write_png(changed.mask, 48, 48, half);
    CHECK_FALSE(streamed_view(changed).read_planes);
    options.resolution = 2;
    CHECK_FALSE(streamed_view(record).read_planes);

    fs::last_write_time(record.file, fs::last_write_time(record.file) + std::chrono::seconds(2));
    CHECK(says(error_of([&] { view.read_planes(planes); }), {"photo.jpg", "has changed", "--resume"}));
}

TEST_CASE("streamed views: files that change or vanish are reported with their names") {
    const temporary_folder folder;
    const auto records = records_in(folder.path());
    gs::load_options options;
    options.most_photo_bytes = 0;
    const auto views = gs::load_views(records, options, [](const std::string&) {});
    const auto message = [&](std::size_t view) {
        return error_of([&] {
            gs::photo decoded;
            views[view].decode(decoded);
        });
    };
    CHECK(message(0).empty());
    fs::last_write_time(records[0].mask, fs::last_write_time(records[0].mask) + std::chrono::seconds(2));
    CHECK(says(message(0), {"mask.png", "has changed", "--resume"}));
    fs::remove(records[1].file);
    CHECK(says(message(1), {"photo1.png", "cannot read", "--resume"}));
}

TEST_CASE("streamed views: a photo that cannot be used is refused when the scene is loaded") {
    const temporary_folder folder;
    auto records = records_in(folder.path());
    records[1].masked_border = 24;
    gs::load_options options;
    options.most_photo_bytes = 0;
    CHECK(says(error_of([&] { gs::load_views(records, options, [](const std::string&) {}); }),
               {"photo1.png", "masked border"}));
}
