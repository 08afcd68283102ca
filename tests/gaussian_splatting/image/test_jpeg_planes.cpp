// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <random>
#include <utility>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "image/image.hpp"
#include "image/jpeg_planes.hpp"
#include "write_jpeg.hpp"

namespace {

using gs_test::jpeg_kind;

/// Samples of all values, also next to each other.
std::vector<std::uint8_t> random_samples(int width, int height) {
    std::mt19937 random(1);
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(3 * width * height));
    for (std::uint8_t& s : samples) s = static_cast<std::uint8_t>(random());
    return samples;
}

}  // namespace

TEST_CASE("jpeg planes: they give the pixels of read_image, for any size") {
    const gs_test::temporary_folder folder;
    const auto file = folder.path() / "photo.jpg";
    gs::jpeg_planes planes;
    for (const bool progressive : {false, true})
        for (const int down : {1, 2})
            for (const auto& [width, height] :
                 {std::pair{5, 1}, {6, 2}, {7, 5}, {16, 16}, {17, 33}, {31, 15}, {32, 18}, {70, 47}}) {
                CAPTURE(width);
                CAPTURE(height);
                CAPTURE(down);
                CAPTURE(progressive);
                gs_test::write_jpeg(file, width, height, {JCS_RGB, progressive, false, false, 2, down},
                                    random_samples(width, height));
                gs::read_jpeg_planes(file, planes);
                CHECK(planes.has_half_height_colors == (down == 2));
                CHECK(planes.bytes() == gs::jpeg_plane_bytes(file));
                CHECK(planes.samples.size() == planes.bytes());
                const gs::image expected = gs::read_image(file);
                std::vector<std::uint8_t> rgba(expected.rgba.size());
                gs::to_rgba(planes, rgba.data());
                CHECK(rgba == expected.rgba);
            }
}

TEST_CASE("jpeg planes: a photo with colors for 2 x 2 pixels takes 1.5 bytes per pixel") {
    const gs_test::temporary_folder folder;
    gs_test::write_jpeg(folder.path() / "photo.jpg", 64, 48, {JCS_RGB, false, false, false, 2, 2},
                        random_samples(64, 48));
    CHECK(gs::jpeg_plane_bytes(folder.path() / "photo.jpg") == 64 * 48 * 3 / 2);
}

TEST_CASE("jpeg planes: other files have none") {
    const gs_test::temporary_folder folder;
    const auto file = folder.path() / "photo";
    const auto bytes_of = [&](int width, const jpeg_kind& kind, int channels) {
        gs_test::write_jpeg(file, width, 16, kind, gs_test::smooth_samples(width, 16, channels));
        return gs::jpeg_plane_bytes(file);
    };
    CHECK(bytes_of(16, {JCS_RGB, false, false, false, 2, 2}, 3) > 0);
    CHECK(bytes_of(16, {JCS_RGB}, 3) == 0);
    CHECK(bytes_of(16, {JCS_RGB, false, false, false, 1, 2}, 3) == 0);
    CHECK(bytes_of(16, {JCS_GRAYSCALE}, 1) == 0);
    CHECK(bytes_of(16, {JCS_CMYK}, 4) == 0);
    CHECK(bytes_of(4, {JCS_RGB, false, false, false, 2, 2}, 3) == 0);
    gs::write_png(file, 16, 16, std::vector<float>(3 * 16 * 16, 0.5F));
    CHECK(gs::jpeg_plane_bytes(file) == 0);
}

TEST_CASE("jpeg planes: damaged files are refused with their names") {
    const gs_test::temporary_folder folder;
    const auto file = folder.path() / "photo.jpg";
    gs_test::write_jpeg(file, 64, 64, {JCS_RGB, false, false, false, 2, 2}, random_samples(64, 64));
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    CHECK(gs::jpeg_plane_bytes(file) > 0);
    gs::jpeg_planes planes;
    CHECK(gs_test::says(gs_test::error_of([&] { gs::read_jpeg_planes(file, planes); }),
                        {"photo.jpg", "damaged or truncated"}));
}
