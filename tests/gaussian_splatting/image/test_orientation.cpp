// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "image/image.hpp"
#include "make_images.hpp"
#include "write_jpeg.hpp"

namespace {

using gs::image;
using gs_test::temporary_folder;

/// An image as rows of letters, each of which is a gray level.
using letters = std::vector<std::string>;

const letters upright{"AB", "CD", "EF"};

struct stored_image {
    unsigned orientation;
    letters rows;
};

/// How the EXIF standard stores the upright image. It defines where the first row and the first
/// column of the stored image are seen: 1 top and left, 2 top and right, 3 bottom and right, 4 bottom
/// and left, 5 left and top, 6 right and top, 7 right and bottom, 8 left and bottom.
const stored_image all_orientations[] = {
    {1, {"AB", "CD", "EF"}}, {2, {"BA", "DC", "FE"}}, {3, {"FE", "DC", "BA"}}, {4, {"EF", "CD", "AB"}},
    {5, {"ACE", "BDF"}},     {6, {"BDF", "ACE"}},     {7, {"FDB", "ECA"}},     {8, {"ECA", "FDB"}},
};

int width_of(const letters& rows) { return static_cast<int>(rows[0].size()); }
int height_of(const letters& rows) { return static_cast<int>(rows.size()); }
int level(char letter) { return 40 * (letter - 'A') + 10; }

/// Pixels of an image in which each letter is a square of `side` pixels.
std::vector<std::uint8_t> pixels(const letters& rows, int side, int channels) {
    std::vector<std::uint8_t> result;
    for (int y = 0; y < side * height_of(rows); ++y)
        for (int x = 0; x < side * width_of(rows); ++x)
            for (int channel = 0; channel < channels; ++channel) {
                const char letter =
                    rows[static_cast<std::size_t>(y / side)][static_cast<std::size_t>(x / side)];
                result.push_back(static_cast<std::uint8_t>(channel == 3 ? 255 : level(letter)));
            }
    return result;
}

std::string png_of(const letters& rows) {
    const temporary_folder folder;
    std::vector<float> planes;
    for (int plane = 0; plane < 3; ++plane)
        for (const std::uint8_t value : pixels(rows, 1, 1))
            planes.push_back(static_cast<float>(value) / 255.0F);
    gs::write_png(folder / "a.png", width_of(rows), height_of(rows), planes);
    return gs_test::read_file(folder / "a.png");
}

std::string jpeg_of(const letters& rows) {
    const temporary_folder folder;
    gs_test::write_jpeg(folder / "a.jpg", 8 * width_of(rows), 8 * height_of(rows), {JCS_RGB},
                        pixels(rows, 8, 3));
    return gs_test::read_file(folder / "a.jpg");
}

std::string webp_of(const letters& rows) {
    return gs_test::webp_of(width_of(rows), height_of(rows), pixels(rows, 1, 4), 100);
}

/// Reads a file, checks that its header has the stored size, and returns the upright image.
image read_upright(const std::string& bytes, const letters& stored, int side) {
    const temporary_folder folder;
    gs_test::write_file(folder / "photo", bytes);
    const gs::image_header header = gs::read_image_header(folder / "photo");
    CHECK(header.width == side * width_of(stored));
    CHECK(header.height == side * height_of(stored));
    return gs::turned_upright(gs::read_image(folder / "photo"), header.turn);
}

void check_shows(const image& shown, const letters& rows, int side) {
    REQUIRE(shown.width == side * width_of(rows));
    REQUIRE(shown.height == side * height_of(rows));
    const std::vector<std::uint8_t> expected = pixels(rows, side, 4);
    for (std::size_t i = 0; i < expected.size(); ++i)
        REQUIRE(std::abs(shown.rgba[i] - expected[i]) <= (side == 1 ? 0 : 2));
}

gs::orientation orientation_in_png(const std::string& exif) {
    const temporary_folder folder;
    gs_test::write_file(folder / "photo", gs_test::png_with_exif(png_of(upright), exif));
    return gs::read_image_header(folder / "photo").turn;
}

}  // namespace

TEST_CASE("the eight EXIF orientations of PNG, JPEG and WebP, in both byte orders") {
    for (const auto& [orientation, rows] : all_orientations)
        for (const bool little : {false, true}) {
            CAPTURE(orientation);
            CAPTURE(little);
            const std::string exif = gs_test::exif(orientation, little);
            check_shows(read_upright(gs_test::png_with_exif(png_of(rows), exif), rows, 1), upright, 1);
            check_shows(read_upright(gs_test::jpeg_with_exif(jpeg_of(rows), exif), rows, 8), upright, 8);
            const std::string webp =
                gs_test::webp_with_exif(webp_of(rows), width_of(rows), height_of(rows), exif);
            check_shows(read_upright(webp, rows, 1), upright, 1);
        }
}

TEST_CASE("the size of an image is that after its EXIF orientation") {
    const temporary_folder folder;
    for (const unsigned orientation : {3U, 6U}) {
        gs_test::write_file(folder / "photo",
                            gs_test::png_with_exif(png_of(upright), gs_test::exif(orientation)));
        int width = 0, height = 0;
        gs::read_image_size(folder / "photo", width, height);
        CHECK(width == (orientation == 6 ? 3 : 2));
        CHECK(height == (orientation == 6 ? 2 : 3));
    }
}

TEST_CASE("absent or malformed EXIF data specify no orientation") {
    const std::string good = gs_test::exif(6);
    REQUIRE(orientation_in_png(good) != gs::orientation());
    CHECK(orientation_in_png(gs_test::exif(0)) == gs::orientation());
    CHECK(orientation_in_png(gs_test::exif(9)) == gs::orientation());
    // 18 bytes before the value; the offset to further tags behind it may be missing.
    for (std::size_t length = 1; length < 18; ++length)
        CHECK(orientation_in_png(good.substr(0, length)) == gs::orientation());
    std::string as_byte = good;
    as_byte[12] = 1;  // the type of the value
    CHECK(orientation_in_png(as_byte) == gs::orientation());
}
