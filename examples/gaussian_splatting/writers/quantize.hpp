// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gs {

inline double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

/// Returns the nearest byte.
inline std::uint8_t to_byte(double x) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0, 255.0)));
}

/// Returns the nearest of the integers 0 to `most` to `x * most`.
inline std::uint32_t to_unorm(double x, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(x, 0.0, 1.0) * most));
}

/// Returns the byte of an opacity, which is a logit in the model.
inline std::uint8_t opacity_to_byte(float logit) { return to_byte(255 * sigmoid(logit)); }

/// Returns the logit of an opacity byte. 0 and 255 are read as half a step inside, because the
/// opacities 0 and 1 have no logit.
inline float byte_to_opacity(std::uint8_t byte) {
    const double alpha = std::clamp<double>(byte, 0.5, 254.5) / 255;
    return static_cast<float>(std::log(alpha / (1 - alpha)));
}

}  // namespace gs
