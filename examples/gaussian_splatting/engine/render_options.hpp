// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace gs::train {

/// How `engine::render` draws the model, and which part of the render it returns.
struct render_options {
    int sh_degree = 3;  ///< draws SH coefficients up to this degree
    /// Draws inverse depths instead of colors, as one plane: the sum of w_i / z_i with the weights of the
    /// colors, in internal units, on a background of zero.
    bool inverse_depth = false;
    /// Uses memory that training does not use, so that the render cannot change later steps, such as
    /// the number of steps whose tile lists do not fit. Costs the memory of a second renderer.
    bool separate_memory = false;
    /// Returns the means of square blocks of this side, row by row. Leaves out incomplete blocks at the right
    /// and the lower border.
    int block = 1;
    /// Returns only these pixels, unless it is empty: see `rendered_pixels::some`. Then `block` must be 1.
    std::span<const std::uint32_t> pixels{};
};

}  // namespace gs::train
