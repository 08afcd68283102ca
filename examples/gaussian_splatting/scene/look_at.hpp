// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scene.hpp"

namespace gs {

/// A camera at `from` with `to` in the middle of its square picture of `size` pixels a side; `focal` is in
/// pixels. Precondition: the direction is not that of `up`, which is upwards in the picture.
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
