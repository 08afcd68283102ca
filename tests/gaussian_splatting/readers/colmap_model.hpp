// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "../../support/bytes.hpp"
#include "../../support/temporary_folder.hpp"
#include "known_scene.hpp"
#include "readers/load_scene.hpp"

/// @file
/// COLMAP models for tests, written as binary files and as text.

namespace gs_test {

struct camera_record {
    std::uint32_t id;
    std::int32_t model_id;
    std::string model;
    std::uint64_t width, height;
    std::vector<double> parameters;
};

struct image_record {
    std::array<double, 4> quaternion;
    std::array<double, 3> translation;
    std::uint32_t camera_id;
    std::string name;
    std::vector<std::array<double, 2>> tracked;
};

struct point_record {
    std::array<double, 3> position;
    std::array<std::uint8_t, 3> color;
    std::uint32_t track_length;
};

struct model_record {
    std::vector<camera_record> cameras;
    std::vector<image_record> images;
    std::vector<point_record> points;
};

inline std::string cameras_bin(const model_record& model) {
    bytes out;
    out.put(std::uint64_t{model.cameras.size()});
    for (const auto& c : model.cameras) {
        out.put(c.id).put(c.model_id).put(c.width).put(c.height);
        for (const double parameter : c.parameters) out.put(parameter);
    }
    return out.data();
}

inline std::string images_bin(const model_record& model) {
    bytes out;
    out.put(std::uint64_t{model.images.size()});
    std::uint32_t id = 1;
    for (const auto& i : model.images) {
        out.put(id++).put(i.quaternion).put(i.translation).put(i.camera_id).put_text(i.name);
        out.put(std::uint64_t{i.tracked.size()});
        for (const auto& at : i.tracked) out.put(at).put(std::int64_t{-1});
    }
    return out.data();
}

inline std::string points_bin(const model_record& model) {
    bytes out;
    out.put(std::uint64_t{model.points.size()});
    std::uint64_t id = 1;
    for (const auto& p : model.points) {
        out.put(id++).put(p.position).put(p.color).put(0.5).put(std::uint64_t{p.track_length});
        for (std::uint32_t i = 0; i < p.track_length; ++i) out.put(i).put(i);
    }
    return out.data();
}

inline std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);  // 17 digits bring back the same double
    return text;
}

template <class Range>
inline std::string words_of(const Range& values) {
    std::string text;
    for (const double value : values) text += " " + text_of(value);
    return text;
}

inline std::string cameras_txt(const model_record& model) {
    std::string out = "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, ...\n";
    for (const auto& c : model.cameras)
        out += std::to_string(c.id) + " " + c.model + " " + std::to_string(c.width) + " " +
               std::to_string(c.height) + words_of(c.parameters) + "\n";
    return out;
}

inline std::string images_txt(const model_record& model) {
    std::string out = "# Image list with two lines of data per image:\n";
    int id = 1;
    for (const auto& i : model.images) {
        out += std::to_string(id++) + words_of(i.quaternion) + words_of(i.translation) + " " +
               std::to_string(i.camera_id) + " " + i.name + "\n";
        for (const auto& at : i.tracked) out += words_of(at) + " -1";
        out += "\n";
    }
    return out;
}

inline std::string points_txt(const model_record& model) {
    std::string out = "# 3D point list with one line of data per point:\n";
    int id = 1;
    for (const auto& p : model.points) {
        out += std::to_string(id++) + words_of(p.position) + words_of(p.color) + " 0.5";
        for (std::uint32_t i = 0; i < p.track_length; ++i) out += " 1 " + std::to_string(i);
        out += "\n";
    }
    return out;
}

inline void write_binary(const std::filesystem::path& folder, const model_record& model) {
    write_file(folder / "cameras.bin", cameras_bin(model));
    write_file(folder / "images.bin", images_bin(model));
    write_file(folder / "points3D.bin", points_bin(model));
}

inline void write_text(const std::filesystem::path& folder, const model_record& model) {
    write_file(folder / "cameras.txt", cameras_txt(model));
    write_file(folder / "images.txt", images_txt(model));
    write_file(folder / "points3D.txt", points_txt(model));
}

/// Two pinhole cameras of which one has two focal lengths, three images out of order, two points.
inline model_record plain_model() {
    model_record model;
    model.cameras = {{1, 1, "PINHOLE", 40, 30, {50, 35, 19, 16}},
                     {7, 0, "SIMPLE_PINHOLE", 40, 30, {44, 20.5, 14}}};
    model.images = {
        {{0.5, -0.1, 0.7, 0.2}, {0.25, -1, 3}, 7, "c.png", {}},
        {{1, 0, 0, 0}, {0, 0, 0}, 1, "a.png", {{1.5, 2.5}, {3.25, 4}}},
        {{std::sqrt(0.5), 0, 0, -std::sqrt(0.5)}, {1, 2, 3}, 1, "b.png", {}},
    };
    model.points = {{{1, 2, 3}, {10, 20, 30}, 2}, {{-1, 0.1, 5e-3}, {0, 255, 128}, 0}};
    return model;
}

/// Images of one place by one camera, and one point.
inline model_record photos_by(const camera_record& camera, const std::vector<std::string>& names) {
    model_record model;
    model.cameras = {camera};
    for (const std::string& name : names) model.images.push_back({{1, 0, 0, 0}, {0, 0, 0}, 1, name, {}});
    model.points = {{{0, 0, 1}, {1, 2, 3}, 0}};
    return model;
}

inline void write_photo(const std::filesystem::path& file, int width, int height) {
    std::filesystem::create_directories(file.parent_path());
    std::vector<float> planes(static_cast<std::size_t>(3 * width * height), 0.5F);
    gs::write_png(file, width, height, planes);
}

inline void write_photos(const std::filesystem::path& folder, const model_record& model, int width,
                         int height) {
    for (const auto& i : model.images) write_photo(folder / i.name, width, height);
}

/// A whole scene of the plain model in binary files.
inline void write_scene(const std::filesystem::path& folder) {
    write_binary(folder / "sparse/0", plain_model());
    write_photos(folder / "images", plain_model(), 40, 30);
}

inline void ignore(const std::string&) {}

inline std::string error_of_loading(const gs::load_options& options) {
    return error_of([&] { gs::load_scene(options, ignore); });
}

inline std::string error_of_loading(const std::filesystem::path& folder) {
    return error_of_loading(options_for(folder));
}

/// Returns the pixel at which the camera sees a point.
inline glm::dvec2 project(const gs::camera& camera, const glm::dvec3& point) {
    const glm::dvec3 p = camera.rotation * point + camera.translation;
    return {camera.fx * p.x / p.z + camera.cx, camera.fy * p.y / p.z + camera.cy};
}

inline constexpr double rounding = 1e-12;  // some operations on doubles of about 1 to 100

}  // namespace gs_test
