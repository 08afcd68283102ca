// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "../scene/camera.hpp"
#include "../scene/normalization.hpp"

namespace gs::video {

/// A camera that a path passes through, in world coordinates.
struct key_view {
    glm::dvec3 position{0};
    glm::dquat axes{1, 0, 0, 0};  ///< turns camera axes (x right, y down, z forward) to world axes
    double field_of_view = 0.8;   ///< of the height, in radians
};

/// The path of a camera through key views, at equal distances in time.
struct camera_path {
    std::vector<key_view> views;    ///< at least one
    std::optional<double> seconds;  ///< if the file has it
    std::optional<int> width, height;

    /// Returns the view at a share of the time, from 0 to 1. Positions follow a curve through the
    /// key views (Catmull and Rom 1974). Rotations and fields of view are interpolated between the
    /// two nearest ones.
    key_view at(double share) const;
};

/// Reads a path in nerfstudio's format (`camera_path`) or in our own (`cameras`): see
/// docs/how-to/render_a_video.md. Throws `error` with the file and the value that is malformed.
camera_path read_camera_path(const std::filesystem::path& file);

/// Returns the camera of a view in internal coordinates.
camera camera_of(const key_view& view, const normalization& normalization, int width, int height);

}  // namespace gs::video
