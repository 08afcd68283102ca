// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "synthetic_parameters.hpp"

namespace gs {

/// Returns the place at which a ray reaches the walls. They are a cube around the origin, whose half
/// side is twice the largest distance of a camera. Preconditions: the origin of the ray is inside, and
/// `direction` is not zero.
glm::dvec3 place_on_walls(const synthetic_parameters& how, const glm::dvec3& origin,
                          const glm::dvec3& direction);

/// Returns the displayed color, in [0, 1], of a place on the walls. A lamp lights them unevenly, but
/// they have no edges.
glm::dvec3 wall_color(const synthetic_parameters& how, const glm::dvec3& place);

}  // namespace gs
