// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "validation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <numeric>
#include <string>

#include "../core/error.hpp"
#include "size_text.hpp"

namespace gs {
namespace {

bool has_orthonormal_columns(const glm::dmat3& matrix, double tolerance) {
    const glm::dmat3 product = glm::transpose(matrix) * matrix;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(product[column][row] - (column == row ? 1.0 : 0.0)) <= tolerance)) return false;
    return true;
}

}  // namespace

// NaN fails all these conditions.
bool has_valid_intrinsics(const camera& taken_with, const lens& distortion) {
    constexpr double least_focal_length = 1e-6, largest = 1e9;
    const auto k = taken_with.fisheye ? taken_with.fisheye->k() : std::array<double, 4>{};
    for (const double value :
         {taken_with.fx, taken_with.fy, taken_with.cx, taken_with.cy, distortion.k1, distortion.k2,
          distortion.p1, distortion.p2, distortion.k3, k[0], k[1], k[2], k[3]})
        if (!(std::abs(value) <= largest)) return false;
    return taken_with.fx >= least_focal_length && taken_with.fy >= least_focal_length;
}

camera panorama_of_size(int width, int height, const std::string& where) {
    constexpr double tolerance = 0.02;
    if (!(std::abs(0.5 * width / height - 1) <= tolerance))
        throw error(where + ": a panorama of all directions is twice as wide as high, but this one has " +
                    size_text(width, height) +
                    " pixels; if it lacks the top or the bottom, add bars there and mask them");
    return camera::panorama(width, height);
}

bool is_valid_position(const glm::dvec3& position) {
    constexpr double farthest = 1e30;
    return std::abs(position.x) <= farthest && std::abs(position.y) <= farthest &&
           std::abs(position.z) <= farthest;
}

std::optional<glm::dmat3> nearest_rotation(const glm::dmat3& matrix) {
    if (!(has_orthonormal_columns(matrix, 1e-3) && glm::determinant(matrix) > 0)) return {};
    glm::dmat3 rotation = matrix;
    for (int i = 0; i < 4; ++i) rotation = 0.5 * (rotation + glm::transpose(glm::inverse(rotation)));
    return rotation;
}

void hold_out_views(std::vector<image_record>& images, const load_options& options) {
    if (!options.eval) return;
    if (options.test_every < 1)
        throw error("test_every must be at least 1, not " + std::to_string(options.test_every));
    std::vector<std::size_t> order(images.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) -> const std::string& { return images[i].name; });
    for (std::size_t i = 0; i < order.size(); i += static_cast<std::size_t>(options.test_every))
        images[order[i]].held_out = true;
}

}  // namespace gs
