// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../image/depth_map.hpp"
#include "../image/image.hpp"
#include "../image/jpeg_planes.hpp"
#include "camera.hpp"
#include "lens.hpp"
#include "normalization.hpp"

namespace gs {

/// The pixels and the depth map of a view.
struct photo {
    image pixels;
    depth_map depths{};  ///< has the photo's size, or is empty
};

/// One photo with its camera, both at the resolution of training. A view holds its photo, or it can
/// decode it: see `view_photo`, which returns the photo in both cases.
struct view {
    std::string name;  ///< path relative to the images folder, with its ending
    gs::camera camera;
    image pixels;               ///< has size and flags, but no values if `is_streamed`
    depth_map depths{};         ///< has the photo's size, or is empty; has no values if `is_streamed`
    lens removed_distortion{};  ///< of the file, which loading has removed from the photo
    /// The camera of the photo's file, with its size and without this distortion. Its pose has no meaning.
    /// Empty if the photo comes from no file.
    std::optional<gs::camera> camera_of_file{};
    /// Views with the same number were taken at once by cameras that are fixed to each other: a rig.
    std::optional<std::uint32_t> rig_frame{};

    /// Decodes the photo, and replaces the argument, whose memory it reuses. Empty if the view holds
    /// the photo. Threads may call it. Throws `error`, for example if the file has changed since the
    /// view was made.
    std::function<void(photo&)> decode{};
    std::size_t decode_bytes = 0;  ///< largest size of the images that `decode` holds at once
    /// Reads samples that `to_rgba` converts to the pixels that `decode` returns. Empty if the photo is
    /// not exactly as a JPEG stores it. Throws like `decode`.
    std::function<void(jpeg_planes&)> read_planes{};
    std::size_t plane_bytes = 0;  ///< size of these samples, or 0

    bool is_streamed() const { return decode != nullptr; }
};

struct colored_point {
    glm::dvec3 position{0};
    glm::u8vec3 color{0};
};

struct scene {
    std::vector<view> train;
    std::vector<view> test;
    std::vector<colored_point> points;  ///< points from structure from motion, or empty
    bool has_alpha = false;             ///< whether a photo has transparent, unmasked pixels
    /// Whether the cameras look at one object. A scene without points then begins with Gaussians
    /// around that object.
    bool object_centered = false;
    bool rendered = false;  ///< whether a program drew the photos, sharp to the pixel and without noise
    gs::normalization normalization;  ///< of cameras and points; the identity before `normalize`

    /// Returns the extent: 1.1 times the largest distance of a training camera from the mean of all
    /// training cameras. It is the unit of the learning rate of positions and of densification
    /// (Kerbl et al. 2023, reference implementation).
    ///
    /// If all cameras are at one place (up to a millionth of the following distances), returns the
    /// median distance of the points from this place. Without points, returns the distance of
    /// `looked_at`. If that does not exist either, returns 1 in world units.
    double extent() const;

    /// Returns the point nearest to the optical axes of the training cameras, by least squares. The
    /// axes may leave directions undetermined (a single camera, parallel axes). In these directions
    /// the point is nearest to the world origin, where scenes without points have their object.
    /// Returns nothing if the point is not in front of at least half of the cameras, or if there are
    /// panoramas, which look everywhere.
    std::optional<glm::dvec3> looked_at() const;
};

}  // namespace gs
