// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

namespace gs::train {

/// Describes the values of a render: all pixels of an image, row by row, some of its pixels, or the means of
/// its blocks. See `render_options`.
struct rendered_pixels {
    int width, height;                      ///< of the image
    std::span<const std::uint32_t> some{};  ///< their places among all pixels; empty: all
    int block = 1;                          ///< side of the blocks

    /// Returns the coordinates of the center of pixel or block `i` of a plane: see `camera::image_point`.
    glm::dvec2 center(std::size_t i) const {
        const auto place = static_cast<int>(some.empty() ? i : some[i]), across = width / block;
        return static_cast<double>(block) * glm::dvec2(place % across + 0.5, place / across + 0.5);
    }
};

}  // namespace gs::train
