// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "../image/image.hpp"

namespace gs {

/// The colors of a photo, smoothed, between pixels. Pixels that are masked, transparent or saturated have no
/// color, and neither have the places beside them.
class smooth_colors {
  public:
    /// A color in [0, 1] and its change per pixel.
    struct sample {
        glm::dvec3 color, by_x, by_y;
    };

    explicit smooth_colors(const image& photo);
    /// Returns the color at these pixel coordinates. Interpolates.
    std::optional<sample> at(double x, double y) const;

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_, height_;
    std::vector<glm::vec3> colors_;  ///< means of 3×3 pixels
    std::vector<char> is_known_;
};

}  // namespace gs
