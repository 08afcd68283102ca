// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

#include "../../scene/scene.hpp"

namespace gs {

/// Returns the camera of a training view with the pose that training has learned, in internal coordinates.
using pose_of_view = std::function<camera(std::size_t view)>;

/// Throws `error` if COLMAP has no camera model for a view of the scene.
void require_colmap_cameras(const scene& scene);

/// Writes cameras.bin, images.bin and points3D.bin to a folder, which it creates: the cameras of the photo
/// files, with their lens distortion, the poses of all views in world coordinates, and the points of the
/// scene without observations. Held-out views keep their poses. Precondition: `require_colmap_cameras`.
/// Throws `error` if a file cannot be written.
void write_colmap_model(const std::filesystem::path& folder, const scene& scene, const pose_of_view& learned);

}  // namespace gs
