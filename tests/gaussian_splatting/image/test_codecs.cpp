// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "image/image.hpp"
#include "known_leaks.hpp"
#include "make_images.hpp"
#include "write_jpeg.hpp"

namespace {

using gs::image;
using gs_test::error_of;
using gs_test::heif_of;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::webp_of;
using gs_test::write_file;

/// Smooth colors, and an alpha channel that is opaque on the left and falls to the right.
std::vector<std::uint8_t> smooth_rgba(int width, int height, bool with_alpha) {
    std::vector<std::uint8_t> rgba = gs_test::smooth_samples(width, height, 4);
    for (int i = 0; i < width * height; ++i) {
        const int x = i % width;
        rgba[4 * static_cast<std::size_t>(i) + 3] =
            static_cast<std::uint8_t>(with_alpha && x > width / 2 ? 255 - 4 * x : 255);
    }
    return rgba;
}

/// Largest difference to the premultiplied pixels that straight RGBA pixels must become.
int difference(const image& read, const std::vector<std::uint8_t>& straight) {
    REQUIRE(read.rgba.size() == straight.size());
    long most = 0;
    for (std::size_t i = 0; i < straight.size(); ++i) {
        const double alpha = i % 4 == 3 ? 1 : straight[i - i % 4 + 3] / 255.0;
        most = std::max(most, std::abs(std::lround(straight[i] * alpha) - read.rgba[i]));
    }
    return static_cast<int>(most);
}

image read(const temporary_folder& folder, const std::string& bytes) {
    write_file(folder / "photo", bytes);
    return gs::read_image(folder / "photo");
}

std::string error_of_reading(const temporary_folder& folder, const std::string& bytes) {
    return error_of([&] { read(folder, bytes); });
}

gs::image_header header_of(const temporary_folder& folder, const std::string& bytes) {
    write_file(folder / "photo", bytes);
    return gs::read_image_header(folder / "photo");
}

std::string replaced(std::string bytes, const std::string& from, const std::string& to) {
    const std::size_t at = bytes.find(from);
    REQUIRE(at != std::string::npos);
    return bytes.replace(at, from.size(), to);
}

/// Checks that each damaged copy becomes an error with the name of the file, or an image.
void check_damage(const std::string& original) {
    const temporary_folder folder;
    std::size_t cut_but_read = 0, nameless = 0, refused = 0;
    for (std::size_t length = 0; length < original.size(); ++length) {
        const std::string problem = error_of_reading(folder, original.substr(0, length));
        cut_but_read += problem.empty();
        nameless += !problem.empty() && !says(problem, {"photo"});
    }
    for (std::size_t i = 0; i < original.size(); ++i) {
        std::string changed = original;
        changed[i] = static_cast<char>(~changed[i]);
        const std::string problem = error_of_reading(folder, changed);
        refused += !problem.empty();
        nameless += !problem.empty() && !says(problem, {"photo"});
    }
    CHECK(cut_but_read == 0);
    CHECK(nameless == 0);
    CHECK(refused > 0);
}

}  // namespace

TEST_CASE("WebP: lossless pixels are exact, lossy ones close, with and without alpha") {
    const temporary_folder folder;
    const int width = 37, height = 21;
    for (const bool with_alpha : {false, true}) {
        CAPTURE(with_alpha);
        const auto rgba = smooth_rgba(width, height, with_alpha);
        const std::string lossless = webp_of(width, height, rgba, 100);
        CHECK(header_of(folder, lossless).width == width);
        CHECK(header_of(folder, lossless).height == height);
        const image exact = read(folder, lossless);
        CHECK(exact.has_alpha == with_alpha);
        CHECK(difference(exact, rgba) == 0);
        const image close = read(folder, webp_of(width, height, rgba, 99));
        CHECK(close.has_alpha == with_alpha);
        CHECK(difference(close, rgba) <= 10);
    }
}

TEST_CASE("WebP: an animation, a large size and damage are refused") {
    const temporary_folder folder;
    const std::string still = webp_of(5, 4, smooth_rgba(5, 4, false), 100);
    const std::string extended = gs_test::webp_with_exif(still, 5, 4, gs_test::exif(1));
    constexpr std::size_t flags = 20, width = 24;
    std::string animation = extended;
    animation[flags] = 2;
    CHECK(says(error_of_reading(folder, animation), {"photo", "animation"}));
    std::string large = still;  // lossless: 14 bits each for width - 1 and height - 1
    large[21] = large[22] = large[23] = '\xFF';
    CHECK(says(error_of_reading(folder, large), {"photo", "few for", "16384"}));
    std::string contradicting = extended;
    contradicting[width] = 50;
    CHECK_FALSE(error_of_reading(folder, contradicting).empty());
    check_damage(webp_of(9, 6, smooth_rgba(9, 6, true), 100));
    check_damage(webp_of(9, 6, smooth_rgba(9, 6, false), 80));
}

TEST_CASE("HEIC and AVIF: pixels are close, with and without alpha") {
    const temporary_folder folder;
    const int width = 38, height = 22;
    for (const auto coding : {heif_compression_HEVC, heif_compression_AV1})
        for (const bool with_alpha : {false, true}) {
            CAPTURE(coding);
            CAPTURE(with_alpha);
            const auto rgba = smooth_rgba(width, height, with_alpha);
            const std::string bytes = heif_of(width, height, rgba, {.coding = coding, .alpha = with_alpha});
            CHECK(header_of(folder, bytes).width == width);
            CHECK(header_of(folder, bytes).height == height);
            const image close = read(folder, bytes);
            CHECK(close.has_alpha == with_alpha);
            CHECK(difference(close, rgba) <= 6);
        }
}

TEST_CASE("HEIC: colors that are premultiplied already stay as they are") {
    const temporary_folder folder;
    const int width = 32, height = 16;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < width * height; ++i) rgba.insert(rgba.end(), {90, 60, 30, 100});
    const image found = read(folder, heif_of(width, height, rgba, {.alpha = true, .premultiplied = true}));
    CHECK(found.has_alpha);
    for (std::size_t i = 0; i < rgba.size(); ++i) REQUIRE(std::abs(found.rgba[i] - rgba[i]) <= 3);
}

TEST_CASE("HEIC: the rotation of the file applies once, although EXIF data repeats it") {
    const temporary_folder folder;
    const int width = 32, height = 16;
    const auto rgba = smooth_rgba(width, height, false);
    image stored;
    stored.width = width;
    stored.height = height;
    stored.rgba = rgba;
    const image upright = gs::turned_upright(stored, {.swaps_sides = true, .mirrors_y = true});
    const std::string bytes =
        heif_of(width, height, rgba, {.turn = heif_orientation_rotate_90_cw, .exif_data = gs_test::exif(6)});
    const gs::image_header header = header_of(folder, bytes);
    CHECK(header.width == height);
    CHECK(header.height == width);
    CHECK(header.turn == gs::orientation());
    CHECK(difference(read(folder, bytes), upright.rgba) <= 6);
}

TEST_CASE("HEIC and AVIF: damage and wrong sizes are refused") {
    const temporary_folder folder;
    const auto rgba = smooth_rgba(16, 8, false);
    for (const auto coding : {heif_compression_HEVC, heif_compression_AV1}) {
        const std::string bytes = heif_of(16, 8, rgba, {.coding = coding});
        check_damage(bytes);
        // A size in the header that the coded image does not have.
        const std::string size = gs_test::big_endian(16, 4) + gs_test::big_endian(8, 4);
        const auto sized = [&](std::uint32_t width, std::uint32_t height) {
            return replaced(bytes, "ispe" + std::string(4, '\0') + size,
                            "ispe" + std::string(4, '\0') + gs_test::big_endian(width, 4) +
                                gs_test::big_endian(height, 4));
        };
        CHECK(error_of_reading(folder, sized(16, 8)).empty());
        CHECK(says(error_of_reading(folder, sized(12000, 12000)), {"photo", "too few"}));
        CHECK_FALSE(error_of_reading(folder, sized(70000, 8)).empty());
        CHECK_FALSE(error_of_reading(folder, sized(0, 8)).empty());
        CHECK_FALSE(error_of_reading(folder, sized(18, 8)).empty());
    }
}

TEST_CASE("HEIC and AVIF: a missing decoder is named with its package") {
    const temporary_folder folder;
    for (const auto coding : {heif_compression_HEVC, heif_compression_AV1}) {
        const std::string bytes = heif_of(16, 8, smooth_rgba(16, 8, false), {.coding = coding});
        REQUIRE(error_of_reading(folder, bytes).empty());
        heif_deinit();  // unloads all decoders
        const std::string problem = error_of_reading(folder, bytes);
        REQUIRE(heif_init(nullptr).code == heif_error_Ok);
        CHECK(says(problem,
                   {"photo", "no decoder", "libheif-plugin-libde265", "libheif-plugin-dav1d", "JPEG"}));
        CHECK(error_of_reading(folder, bytes).empty());
    }
}
