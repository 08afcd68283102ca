// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <random>

#include "backend.hpp"

namespace hard_cases {

/// Splats made by hand, in pixels.

/// A round one of this standard deviation before the pixel's filter: 0 covers a pixel and its neighbors,
/// 1000 gives an image of a few tiles the same alpha everywhere.
inline flat_splat round_splat(double x, double y, double width, double opacity) {
    return {x, y, opacity, {width, 0, 0}, {0, width, 0}, {0, 0, 0}};
}

/// Any orientation, somewhere in the box of this size.
inline flat_splat random_splat(std::mt19937& random, int width, int height, double opacity) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    flat_splat s{uniform(random) * width, uniform(random) * height, opacity};
    for (auto* row : {&s.across, &s.down})
        for (double& x : *row) x = 3 * normal(random);
    return s;
}

inline blend_case empty_list(int width, int height) {
    blend_case q{};
    q.width = width;
    q.height = height;
    return q;
}

/// A gradient by the image that looks at one pixel of each tile in each channel.
inline std::vector<double> one_pixel_a_tile(std::mt19937& random, int width, int height) {
    const auto pixels = static_cast<std::size_t>(width * height);
    std::vector<double> gradient(3 * pixels, 0.0);
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (int top = 0; top < height; top += 16)
            for (int left = 0; left < width; left += 16) {
                const int y =
                    top + static_cast<int>(random() % static_cast<unsigned>(std::min(16, height - top)));
                const int x =
                    left + static_cast<int>(random() % static_cast<unsigned>(std::min(16, width - left)));
                gradient[channel * pixels + static_cast<std::size_t>(y * width + x)] = 1;
            }
    return gradient;
}

/// T at the first splat of a list as the backward pass recovers it, over what it is, 1. `alpha` is what the
/// forward pass gave that splat.
inline double recovered(const blend_result& a, std::size_t splat, std::size_t channel, double alpha) {
    return a.sums[splat][channel] / alpha;
}

}  // namespace hard_cases
