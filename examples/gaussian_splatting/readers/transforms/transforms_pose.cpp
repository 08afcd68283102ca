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
namespace {

bool is_near_rotation(const glm::dmat3& matrix, double tolerance) {
    const glm::dmat3 product = glm::transpose(matrix) * matrix;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)  // written so that NaN fails too
            if (!(std::abs(product[column][row] - (column == row ? 1.0 : 0.0)) <= tolerance)) return false;
    return true;
}

/// The rotation that is nearest to an almost orthogonal matrix (Newton's iteration for the polar
/// decomposition).
glm::dmat3 nearest_rotation(glm::dmat3 matrix) {
    for (int i = 0; i < 4; ++i) matrix = 0.5 * (matrix + glm::transpose(glm::inverse(matrix)));
    return matrix;
}

}  // namespace

void set_pose(transforms_frame& frame, const glm::dmat4& matrix, const std::string& where) {
    constexpr double tolerance = 1e-3;
    const glm::dmat3 axes(matrix);
    const double volume = glm::determinant(axes);
    if (std::abs(volume) < 1e-9) throw error(where + ": transform_matrix is singular");
    const glm::dvec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3] - 1);
    if (!(volume > 0 && is_near_rotation(axes, tolerance) && glm::dot(last_row, last_row) <= tolerance))
        throw error(where + ": transform_matrix is not a rotation and a translation");
    const glm::dmat3 to_world = nearest_rotation(axes);
    const glm::dmat3 ours(to_world[0], -to_world[1], -to_world[2]);
    frame.rotation = glm::transpose(ours);
    frame.translation = -frame.rotation * glm::dvec3(matrix[3]);
    if (!is_valid_position(matrix[3]))
        throw error(where + ": the translation of transform_matrix" + invalid_position);
}

}  // namespace gs
