// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "png_psnr.hpp"

#include <cmath>
#include <cstdint>

namespace gs::evaluate {

double png_psnr(const std::vector<float>& render, const std::vector<float>& target, const image& photo) {
    const std::size_t pixels = render.size() / 3;
    std::int64_t squares = 0, values = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (photo.is_masked(i)) continue;
        for (std::size_t at = i; at < 3 * pixels; at += pixels) {
            const int difference = to_byte(render[at]) - to_byte(target[at]);
            squares += difference * difference;
        }
        values += 3;
    }
    constexpr double white = 255;
    return -10 * std::log10(static_cast<double>(squares) / static_cast<double>(values) / (white * white));
}

}  // namespace gs::evaluate
