// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "transforms_pose.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "../../core/error.hpp"
#include "../validation.hpp"

namespace gs {

void set_pose(transforms_frame& frame, const glm::dmat4& matrix, const std::string& where) {
    const glm::dmat3 axes(matrix);
    if (std::abs(glm::determinant(axes)) < 1e-9) throw error(where + ": transform_matrix is singular");
    const glm::dvec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3] - 1);
    const auto to_world = nearest_rotation(axes);
    if (!(to_world && glm::dot(last_row, last_row) <= 1e-3))
        throw error(where + ": transform_matrix is not a rotation and a translation");
    const glm::dmat3 ours((*to_world)[0], -(*to_world)[1], -(*to_world)[2]);
    frame.rotation = glm::transpose(ours);
    frame.translation = -frame.rotation * glm::dvec3(matrix[3]);
    if (!is_valid_position(matrix[3]))
        throw error(where + ": the translation of transform_matrix" + invalid_position);
}

}  // namespace gs
