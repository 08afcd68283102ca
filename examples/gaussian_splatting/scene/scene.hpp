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
    /// The cameras look at one object, so that scenes without points begin with Gaussians around it.
    bool object_centered = false;
    gs::frame frame;  ///< that cameras and points are in: the files' own until `recentre`

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

}  // namespace gs
