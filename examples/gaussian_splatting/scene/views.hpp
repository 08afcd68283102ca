// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene.hpp"
#include "undistort.hpp"

namespace gs {

/// What a scene's files say of one photo, before it is opened.
struct recorded_view {
    std::filesystem::path file;
    std::string name;
    gs::camera camera;  ///< of the size that was recorded
    lens distortion;
    std::string model;  ///< the camera model's name, for messages
};

/// Opens the photos, in parallel and shrinking each at once; the views come in the order of `recorded`.
/// Cameras are fitted to the photos' sizes, straightened, and scaled to the resolution asked for.
std::vector<view> load_views(const std::vector<recorded_view>& recorded, const load_options& options,
                             const log_function& log);

/// Whether all intrinsics are finite and the focal lengths positive.
bool has_sound_intrinsics(const camera& pinhole, const lens& distortion);

}  // namespace gs
