// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene.hpp"
#include "undistort.hpp"

namespace gs {

struct colmap_camera {
    std::uint32_t id = 0;
    std::string model;
    camera intrinsics;  ///< its pose is left at the identity
    lens distortion;
};

struct colmap_image {
    std::string name;
    std::uint32_t camera_id = 0;
    glm::dmat3 rotation{1};
    glm::dvec3 translation{0};
};

struct colmap_model {
    std::vector<colmap_camera> cameras;
    std::vector<colmap_image> images;  ///< in the file's order
    std::vector<coloured_point> points;
    std::filesystem::path images_file;  ///< where `images` came from, for messages
};

/// Reads cameras, images and points3D from a folder; of each, `.bin` is preferred to `.txt`. The points may
/// be missing. Throws `error` naming file, and line or record, where something is malformed.
colmap_model read_colmap_model(const std::filesystem::path& folder);

/// The views of a COLMAP folder, sorted by name; with `eval`, every `test_every`-th is a test view.
scene load_colmap_scene(const load_options& options, const log_function& log);

}  // namespace gs
