// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// A square of a photo.
struct photo_cell {
    enum class content : unsigned char { smooth, rough, transparent };

    glm::vec3 color{0};  ///< mean as displayed, in [0, 1], if the square is opaque
    content shows = content::transparent;
    bool near_points = false;  ///< whether points project into the square or into one of its neighbors
};

/// The squares of a photo. Their side is a 32nd of the photo's longer side, at least 4 pixels. The
/// list has one row after the other and leaves out incomplete squares at the right and at the bottom.
struct photo_cells {
    int side = 1;
    int across = 0, down = 0;
    std::vector<photo_cell> cells;

    /// Returns the pixel coordinates of the middle of a square.
    glm::dvec2 middle(std::size_t cell) const;
    /// Returns the direction of the ray through the middle of a square, of length one.
    glm::dvec3 ray(const camera& taken_with, std::size_t cell) const;
};

/// Returns the squares of each training photo. Cost: decodes all photos, and projects all points into
/// each of them.
std::vector<photo_cells> divide_photos(const scene& of);

/// Removes a falloff with these strengths of red, green and blue from the colors of squares: see
/// `lens_falloff`. Within a square it is about linear, so the means of squares suffice. Panoramas have none.
void remove_falloff(const scene& of, const std::array<double, 3>& strengths,
                    std::vector<photo_cells>& photos);

}  // namespace gs::features
