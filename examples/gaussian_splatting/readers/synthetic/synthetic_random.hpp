// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace gs {

/// Returns a uniform number in [0, 1). `std::uniform_real_distribution` is not used, because its
/// results depend on the implementation.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Returns a standard normal number (Box and Muller 1958).
inline double normal(std::mt19937_64& random) {
    const double radius = std::sqrt(-2 * std::log(1 - uniform(random)));
    return radius * std::cos(2 * std::numbers::pi * uniform(random));
}

inline std::uint8_t to_byte(double in_unit_interval) {
    return static_cast<std::uint8_t>(std::lround(255 * in_unit_interval));
}

}  // namespace gs
