// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

#include "../../scene/undistort.hpp"

namespace gs {

/// The kind of lens: the `projection_type` of a camera.
struct opensfm_projection {
    std::string_view name;
    bool two_focal_lengths;  ///< focal_x, focal_y, c_x and c_y instead of focal
    lens_model lens = lens_model::pinhole;
};

/// A camera. Lengths are relative to the longer side of the image.
struct opensfm_camera {
    std::string id;
    const opensfm_projection* projection = nullptr;
    int width = 0, height = 0;
    double focal_x = 0, focal_y = 0, c_x = 0, c_y = 0;
    std::array<double, 4> k{};
    double p1 = 0, p2 = 0;

    gs::camera camera() const;  ///< at the origin, without distortion
    lens distortion() const;
};

struct opensfm_shot {
    std::string name;  ///< name of the photo
    std::string camera_id;
    glm::dvec3 rotation{0};  ///< axis times angle in radians, from the world to the camera
    glm::dvec3 translation{0};
};

struct opensfm_reconstruction {
    std::deque<opensfm_camera> cameras;  ///< sorted by id
    std::deque<opensfm_shot> shots;      ///< sorted by name; their cameras exist
    std::deque<colored_point> points;

    /// Returns the camera of a shot, or null if it does not exist.
    const opensfm_camera* find_camera(const opensfm_shot& shot) const;
};

struct opensfm_reconstructions {
    opensfm_reconstruction largest;  ///< the one with the most shots
    std::size_t count = 0;           ///< number of reconstructions in the file
};

/// Reads `reconstruction.json`. Throws `error` with the file, and the camera, shot or point that is
/// malformed. Allocates at most four times the size of the file plus 64 KiB, also for malformed
/// files.
opensfm_reconstructions read_opensfm_reconstructions(const std::filesystem::path& file);

}  // namespace gs
