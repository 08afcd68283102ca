// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../scene/scene.hpp"
#include "../scene/undistort.hpp"

namespace gs {

/// No file's name is longer on Linux. What std::filesystem makes of a longer one takes many times its size.
inline constexpr std::size_t longest_path = 4096;

/// What a scene's files say of one photo, before it is opened.
struct recorded_view {
    std::filesystem::path file;
    std::string name;
    gs::camera camera;  ///< of the size that was recorded
    lens distortion;
    std::string model;             ///< the camera model's name, for messages
    std::filesystem::path mask;    ///< see `beside_photo`; empty: all of it counts
    std::filesystem::path depths;  ///< its depth map, likewise; empty: it has none
};

/// Opens the photos, in parallel and shrinking each at once; the views come in the order of `recorded`.
/// Cameras are fitted to the photos' sizes, straightened, and scaled to the resolution asked for.
std::vector<view> load_views(const std::vector<recorded_view>& recorded, const load_options& options,
                             const log_function& log);

/// The view with its sides divided by `divisor`, to the nearest pixel: photo and depth map averaged over
/// areas.
view shrunk(const view& full, int divisor);

/// Whether the focal lengths lie between 1e-6 and 1e9 pixels and the rest is finite and at most 1e9: what no
/// change of the photo's size can make overflow.
bool has_sound_intrinsics(const camera& taken_with, const lens& distortion);
inline constexpr const char* unsound_intrinsics =
    " has a focal length that is not between 1e-6 and 1e9, or a parameter that is not finite or beyond 1e9";

/// Whether a position is finite and so near, at most 1e30, that distances to it can be squared.
bool is_sound_place(const glm::dvec3& place);
inline constexpr const char* unsound_place = " is not finite, or beyond 1e30";

}  // namespace gs
