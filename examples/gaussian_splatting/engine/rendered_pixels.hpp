// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

namespace gs::train {

/// The pixels that planes of a render have: all pixels of an image of this size, row by row, or only some of
/// them.
struct rendered_pixels {
    int width, height;
    std::span<const std::uint32_t> some{};  ///< their places among all pixels; empty: all

    /// Returns the coordinates of the center of pixel `i` of a plane: see `camera::image_point`.
    glm::dvec2 center(std::size_t i) const {
        const auto place = static_cast<int>(some.empty() ? i : some[i]);
        return {place % width + 0.5, place / width + 0.5};
    }
};

}  // namespace gs::train
