// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "../model/gaussians.hpp"
#include "scene.hpp"

namespace gs {

/// A circle of cameras around a point, which they look at.
struct orbit {
    glm::dvec3 center{0};
    glm::dvec3 up{0, 0, 1}, ahead{1, 0, 0};  ///< unit vectors at a right angle; the circle starts ahead
    double radius = 1;                       ///< distance from the axis through the center
    double height = 0;                       ///< above the center
    double field_of_view = 0.8;              ///< of the shorter side of images, in radians

    /// Returns a camera on the circle. `turn`: share of the full circle.
    camera camera_at(double turn, int width, int height_of_image) const;
};

/// Returns an orbit around the point that the training cameras look at, or around their mean. It
/// has their median distance and height, their mean up vector, and the field of view of the first
/// one. Precondition: there are training views.
orbit orbit_of(const scene& scene);

/// Returns an orbit around the Gaussians, slightly above the plane of their largest extent.
/// Precondition: the model is not empty, and is normalized by its own normalization: see
/// `normalization_of`.
orbit orbit_of(const gaussians& model);

}  // namespace gs
