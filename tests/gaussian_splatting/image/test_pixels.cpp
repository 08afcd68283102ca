// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "image/image.hpp"
#include "image/mask.hpp"
#include "pixel_at.hpp"
#include "scene/downsample.hpp"

namespace {

using gs::image;
using gs_test::pixel;
using gs_test::pixel_at;

image random_image(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    image made;
    made.width = width;
    made.height = height;
    for (int i = 0; i < width * height; ++i) {
        const auto alpha = static_cast<std::uint8_t>(random() % 256);
        for (int channel = 0; channel < 3; ++channel)
            made.rgba.push_back(static_cast<std::uint8_t>(random() % (alpha + 1U)));
        made.rgba.push_back(alpha);
        made.has_alpha |= alpha != 255;
    }
    return made;
}

}  // namespace

TEST_CASE("a depth map of another size is averaged over what it knows") {
    const gs::depth_map map{4, 2, {10, 20, 0, 0, 30, 40, 0, 8}};
    CHECK(gs::resized(map, 2, 1).values == std::vector<std::uint16_t>{25, 0});
    CHECK(gs::resized(map, 4, 1).values == std::vector<std::uint16_t>{20, 30, 0, 8});
    const gs::depth_map larger = gs::resized(map, 8, 6);
    CHECK(std::pair{larger.width, larger.height} == std::pair{8, 6});
    for (std::size_t y = 0; y < 6; ++y)
        for (std::size_t x = 0; x < 8; ++x)
            CHECK(larger.values[8 * y + x] == map.values[4 * (y / 3) + x / 2]);
    CHECK(gs::resized({3, 1, {30, 60, 90}}, 2, 1).values == std::vector<std::uint16_t>{40, 80});
    CHECK_FALSE(gs::resized({}, 2, 1).is_there());
}

TEST_CASE("downsampling is the exact area average, rounded to nearest") {
    const image source = random_image(14, 9, 3);
    for (const auto& size : {std::pair{14, 9}, {7, 3}, {5, 4}, {13, 8}, {1, 9}, {14, 1}, {1, 1}}) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        CAPTURE(height);
        const image small = gs::downsample(source, width, height);
        REQUIRE(small.width == width);
        REQUIRE(small.height == height);
        // Cut each input pixel into width x height cells: an output pixel covers 14 x 9 whole ones.
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                std::array<int, 4> sums{};
                for (int cell_y = y * 9; cell_y < (y + 1) * 9; ++cell_y)
                    for (int cell_x = x * 14; cell_x < (x + 1) * 14; ++cell_x)
                        for (std::size_t channel = 0; channel < 4; ++channel)
                            sums[channel] += pixel_at(source, cell_x / width, cell_y / height)[channel];
                for (std::size_t channel = 0; channel < 4; ++channel)
                    REQUIRE(pixel_at(small, x, y)[channel] == (2 * sums[channel] + 14 * 9) / (2 * 14 * 9));
            }
    }
}

TEST_CASE("downsampling keeps an opaque image opaque") {
    image opaque = random_image(10, 10, 5);
    for (std::size_t i = 3; i < opaque.rgba.size(); i += 4) opaque.rgba[i] = 255;
    opaque.has_alpha = false;
    const image small = gs::downsample(opaque, 3, 7);
    CHECK_FALSE(small.has_alpha);
    for (std::size_t i = 3; i < small.rgba.size(); i += 4) REQUIRE(small.rgba[i] == 255);
}

TEST_CASE("a downsampled view has the camera of its photo") {
    gs::view full;
    full.name = "a.png";
    full.pixels = random_image(35, 9, 4);
    full.camera.width = 35;
    full.camera.height = 9;
    full.camera.fx = 70;
    full.camera.fy = 18;
    full.camera.cx = 10.5;
    full.camera.cy = 4.5;
    full.camera.translation = {1, 2, 3};
    const gs::view half = gs::downsampled(full, 2);
    CHECK(half.name == "a.png");
    CHECK(half.camera.width == 18);
    CHECK(half.camera.height == 5);
    CHECK(half.camera.fx == doctest::Approx(70 * 18.0 / 35));
    CHECK(half.camera.fy == doctest::Approx(18 * 5.0 / 9));
    CHECK(half.camera.cx == doctest::Approx(10.5 * 18 / 35));
    CHECK(half.camera.cy == doctest::Approx(2.5));
    CHECK(half.camera.translation == full.camera.translation);
    CHECK(half.pixels.rgba == gs::downsample(full.pixels, 18, 5).rgba);
    CHECK(gs::downsampled(full, 64).camera.height == 1);
    CHECK(gs::downsampled(full, 1).pixels.rgba == full.pixels.rgba);
}

TEST_CASE("a mask leaves pixels out, of averages too") {
    image photo = random_image(6, 4, 3), mask = photo;
    for (std::size_t i = 0; i < 24; ++i) {
        photo.rgba[4 * i + 3] = 255;
        mask.rgba[4 * i] = i % 6 < 3 ? 127 : 128;  // of rows of six the first three
        if (i == 5) mask.rgba[4 * i] = 0;
    }
    const image whole = photo;
    gs::apply_mask(mask, photo);
    CHECK(photo.has_mask);
    CHECK_FALSE(photo.has_alpha);
    for (std::size_t i = 0; i < 24; ++i) {
        CHECK(photo.is_masked(i) == (i % 6 < 3 || i == 5));
        if (!photo.is_masked(i))
            CHECK(std::equal(&photo.rgba[4 * i], &photo.rgba[4 * i] + 4, &whole.rgba[4 * i]));
    }
    const image half = gs::downsample(photo, 3, 2);
    CHECK(half.has_mask);
    CHECK_FALSE(half.has_alpha);
    for (const std::size_t out : {0, 3}) CHECK(half.is_masked(out));
    for (const std::size_t kept : {1, 2, 4, 5}) CHECK_FALSE(half.is_masked(kept));
    for (std::size_t c = 0; c < 3; ++c) {
        const auto value = [&](std::size_t i) { return whole.rgba[4 * i + c]; };
        // Half of the second pixel counts, and three quarters of the third.
        CHECK(std::abs(half.rgba[4 + c] - (value(3) + value(9)) / 2.0) <= 1.5);
        CHECK(std::abs(half.rgba[8 + c] - (value(4) + value(10) + value(11)) / 3.0) <= 1.5);
        CHECK(std::abs(half.rgba[20 + c] - (value(16) + value(17) + value(22) + value(23)) / 4.0) <= 0.5);
    }
    const float background[3] = {1.0F, 0.5F, 0.25F};
    const std::vector<float> over = gs::over_background(photo, background);
    CHECK(over[0] == 1.0F);
    CHECK(over[24] == 0.5F);

    image clear = whole;
    clear.rgba[15] = clear.rgba[14] = clear.rgba[13] = clear.rgba[12] = 0;  // transparent, not left out
    gs::apply_mask(mask, clear);
    CHECK(clear.has_alpha);
    CHECK_FALSE(clear.is_masked(3));
}

TEST_CASE("over_background lays the image over a color") {
    image source;
    source.width = 3;
    source.height = 1;
    source.rgba = {51, 102, 153, 255, 51, 0, 102, 102, 0, 0, 0, 0};
    const float background[3] = {1.0F, 0.5F, 0.25F};
    const std::vector<float> over = gs::over_background(source, background);
    const double expected[] = {0.2, 0.2 + 0.6, 1.0, 0.4, 0.6 * 0.5, 0.5, 0.6, 0.4 + 0.6 * 0.25, 0.25};
    REQUIRE(over.size() == 9);
    for (std::size_t i = 0; i < 9; ++i)
        CHECK(std::abs(static_cast<double>(over[i]) - expected[i]) <
              2e-7);  // two roundings of numbers up to 1
}
