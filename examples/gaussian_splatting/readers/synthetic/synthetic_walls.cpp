// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic_walls.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "synthetic_cameras.hpp"

namespace gs {
namespace {

double half_side(const synthetic_parameters& how) { return 2 * farthest_camera(how); }

}  // namespace

glm::dvec3 place_on_walls(const synthetic_parameters& how, const glm::dvec3& origin,
                          const glm::dvec3& direction) {
    double distance = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0)
            distance = std::min(
                distance, (std::copysign(half_side(how), direction[axis]) - origin[axis]) / direction[axis]);
    return origin + distance * direction;
}

glm::dvec3 wall_color(const synthetic_parameters& how, const glm::dvec3& place) {
    const glm::dvec3 dark{0.30, 0.27, 0.25}, light{1.00, 0.97, 0.92}, lamp{0.4, -0.3, -0.5};
    const glm::dvec3 to_lamp = place / half_side(how) - lamp;
    return how.walls * glm::mix(dark, light, 1 / (1 + 2 * glm::dot(to_lamp, to_lamp)));
}

}  // namespace gs
