// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "camera.hpp"
#include "../image/depth_map.hpp"
#include "normalization.hpp"
#include "../image/image.hpp"

namespace gs {

/// One photo with its camera; both are at the resolution that was asked for.
struct view {
    std::string name;  ///< the file's name below the images folder, with its ending
    gs::camera camera;
    image pixels;
    depth_map depths{};  ///< of the photo's size, or none
};

struct coloured_point {
    glm::dvec3 position{0};
    glm::u8vec3 colour{0};
};

struct scene {
    std::vector<view> train;
    std::vector<view> test;
    std::vector<coloured_point> points;  ///< from structure from motion; empty if the source has none
    bool has_alpha = false;              ///< some photo is not opaque, beside what masks leave out
    std::string source;                  ///< "Blender", "COLMAP" or "synthetic", for messages
    gs::frame frame;                     ///< that cameras and points are in: the files' own until `recentre`

    /// 1.1 times the largest distance of a training camera from their mean: the unit of the learning rate of
    /// positions and of densification (Kerbl et al. 2023, reference implementation). Where all cameras are in
    /// one place, to a millionth of what follows, the median distance of the points from it; without points,
    /// that of `looked_at`; and if that is nowhere, 1 in the files' unit.
    double extent() const;

    /// The point nearest to the optical axes of the training cameras, in the least squares sense. Along what
    /// they leave open (a single camera, parallel axes) the one nearest to the origin of the files, where
    /// scenes without points have their object. None where half of the cameras do not have it ahead.
    std::optional<glm::dvec3> looked_at() const;
};

/// What a resolution means: 1, 2, 4 and 8 divide the size, any other number is the longer side in pixels.
constexpr bool divides_size(int resolution) {
    return resolution == 1 || resolution == 2 || resolution == 4 || resolution == 8;
}

struct load_options {
    std::string data;               ///< a folder, or "synthetic:NAME[,PARAMETER=VALUE...]"
    std::string images = "images";  ///< COLMAP: the folder of photos, relative to `data`
    /// Leave out what masks do: files in COLMAP's `masks`, or mask_path of a transforms file.
    bool masks = true;
    bool depths = true;      ///< COLMAP: read the depth maps in `depths`
    int resolution = 1;      ///< 1, 2, 4, 8 divide the size; any other number is the longer side in pixels
    bool eval = false;       ///< hold out test views
    int test_every = 8;      ///< COLMAP: every n-th view, sorted by name, from the first
    std::uint64_t seed = 0;  ///< synthetic: its point cloud
};

using log_function = std::function<void(const std::string&)>;

/// Reads a scene: `transforms_train.json` marks Blender, `sparse/0` (or `sparse`) COLMAP.
/// What was resized, undistorted or left out is said through `log`. Throws `error`.
scene load_scene(const load_options& options, const log_function& log);

/// The names that follow "synthetic:".
std::vector<std::string> synthetic_scene_names();

}  // namespace gs
