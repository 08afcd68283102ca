// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "camera.hpp"

namespace gs {

/// Returns a camera at `from` that shows `to` in the center of its image, with `up` pointing
/// upward. The image has `size` pixels per side; the focal length is in pixels. Precondition: `up`
/// is not parallel to the viewing direction.
inline camera look_at(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& up, int size,
                      double focal) {
    const glm::dvec3 z = glm::normalize(to - from);
    const glm::dvec3 x = glm::normalize(glm::cross(z, up));
    const glm::dvec3 y = glm::cross(z, x);
    camera c;
    c.width = c.height = size;
    c.fx = c.fy = focal;
    c.cx = c.cy = 0.5 * size;
    c.rotation = glm::transpose(glm::dmat3(x, y, z));
    c.translation = -(c.rotation * from);
    return c;
}

}  // namespace gs
