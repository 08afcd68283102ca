// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../image/depth_map.hpp"
#include "../image/image.hpp"
#include "camera.hpp"
#include "normalization.hpp"

namespace gs {

/// One photo with its camera, both at the resolution of training.
struct view {
    std::string name;  ///< relative to the images folder, with its ending
    gs::camera camera;
    image pixels;
    depth_map depths{};  ///< of the photo's size, or empty
};

struct colored_point {
    glm::dvec3 position{0};
    glm::u8vec3 color{0};
};

struct scene {
    std::vector<view> train;
    std::vector<view> test;
    std::vector<colored_point> points;  ///< from structure from motion; may be empty
    bool has_alpha = false;             ///< some photo has transparent, unmasked pixels
    /// The cameras look at one object, so that scenes without points begin with Gaussians around
    /// it.
    bool object_centered = false;
    gs::normalization normalization;  ///< of cameras and points; the identity until `normalize`

    /// 1.1 times the largest distance of a training camera from the mean of all: the unit of the
    /// learning rate of positions and of densification (Kerbl et al. 2023, reference
    /// implementation). If all cameras are at one place (up to a millionth of the following
    /// distances), it is the median distance of the points from there; without points, the distance
    /// of `looked_at`; and without that, 1 in world units.
    double extent() const;

    /// The point nearest to the optical axes of the training cameras, by least squares. In
    /// directions that the axes do not determine (a single camera, parallel axes) it is nearest to
    /// the origin of the world, where scenes without points have their object. None if it is not in
    /// front of at least half of the cameras.
    std::optional<glm::dvec3> looked_at() const;
};

}  // namespace gs
