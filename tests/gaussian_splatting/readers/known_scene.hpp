// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>
#include <png.h>

#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "readers/load_scene.hpp"
#include "readers/synthetic/synthetic.hpp"

namespace gs_test {

/// A small scene whose cameras, points and photos are known: four photos of 48x48 pixels.
inline gs::scene known_scene(const char* data = "synthetic:spheres,views=4,points=40", int width = 48) {
    gs::load_options options;
    options.data = data;
    options.resolution = width;
    return gs::load_scene(options, {});
}
/// Returns the same scene with panoramas of 96x48 pixels from among the spheres.
inline gs::scene known_panoramas() {
    return known_scene("synthetic:spheres,views=4,points=40,panorama=1,distance=0.5", 96);
}

inline void write_photo(const std::filesystem::path& file, const gs::image& photo) {
    std::filesystem::create_directories(file.parent_path());
    const float black[3] = {0, 0, 0};
    gs::write_png(file, photo.width, photo.height, gs::over_background(photo, black));
}

/// Writes a PNG with one channel of 16 bits.
inline void write_gray(const std::filesystem::path& file, int width, int height,
                       const std::vector<std::uint16_t>& values) {
    std::filesystem::create_directories(file.parent_path());
    png_image gray{};
    gray.version = PNG_IMAGE_VERSION;
    gray.width = static_cast<png_uint_32>(width);
    gray.height = static_cast<png_uint_32>(height);
    gray.format = PNG_FORMAT_LINEAR_Y;
    REQUIRE(png_image_write_to_file(&gray, file.c_str(), 0, values.data(), 0, nullptr) != 0);
}

inline gs::load_options options_for(const std::filesystem::path& data) {
    gs::load_options options;
    options.data = data.string();
    return options;
}

inline gs::scene load(const std::filesystem::path& data) { return gs::load_scene(options_for(data), {}); }

/// Returns the share of color values that differ by more than 2 of 255.
inline double share_of_differences(const gs::image& a, const gs::image& b) {
    REQUIRE(std::pair(a.width, a.height) == std::pair(b.width, b.height));
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) count += std::abs(a.rgba[i] - b.rgba[i]) > 2;
    return static_cast<double>(count) / static_cast<double>(a.rgba.size());
}

/// Checks that the training views of `read` show the scene from the cameras of `known`. Their photos
/// are those of `known`, and renders from their cameras are equal to the photos.
inline void check_views(const gs::scene& read, const gs::scene& known) {
    REQUIRE(read.train.size() == known.train.size());
    std::vector<gs::view> renders = read.train;
    gs::photograph_synthetic("spheres", renders);
    for (std::size_t i = 0; i < renders.size(); ++i) {
        CAPTURE(i);
        CHECK(share_of_differences(read.train[i].pixels, known.train[i].pixels) == 0);
        CHECK(share_of_differences(renders[i].pixels, known.train[i].pixels) < 0.002);
        CHECK(glm::distance(renders[i].camera.center(), known.train[i].camera.center()) < 1e-6);
    }
    // Another camera sees something else, so the comparison can fail.
    CHECK(share_of_differences(renders[0].pixels, known.train[1].pixels) > 0.1);
}

/// Checks that the points are equal up to the rounding of floats.
inline void check_points(const gs::scene& read, const gs::scene& known) {
    REQUIRE(read.points.size() == known.points.size());
    for (std::size_t i = 0; i < read.points.size(); ++i) {
        CAPTURE(i);
        CHECK(glm::distance(read.points[i].position, known.points[i].position) < 1e-6);
        CHECK(read.points[i].color == known.points[i].color);
    }
}

}  // namespace gs_test
