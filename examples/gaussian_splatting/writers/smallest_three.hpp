// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gs {

/// A rotation without the component of the largest magnitude, which the others determine. Several
/// formats store rotations in this way.
struct smallest_three {
    std::size_t largest;           ///< index of the component that is left out
    std::array<double, 3> others;  ///< the others in their order, from -1 to 1: times sqrt(2)
};

/// Returns the three smallest components of a quaternion of any length but zero. The order of its
/// components is that of the format.
inline smallest_three smallest_three_of(std::array<double, 4> q) {
    double length = 0;
    for (const double x : q) length = std::hypot(length, x);
    std::size_t largest = 0;
    for (std::size_t k = 1; k < 4; ++k)
        if (std::abs(q[k]) > std::abs(q[largest])) largest = k;
    const double factor = (q[largest] < 0 ? -1 : 1) * std::sqrt(2.0) / length;
    smallest_three result{largest, {}};
    for (std::size_t k = 0, i = 0; k < 4; ++k)
        if (k != largest) result.others[i++] = std::clamp(q[k] * factor, -1.0, 1.0);
    return result;
}

/// Returns the unit quaternion of its smallest three components. If rounding made them longer than
/// one, the component left out becomes zero, and the quaternion is not normalized.
inline std::array<double, 4> quaternion_of(const smallest_three& q) {
    std::array<double, 4> result{};
    double square = 1;
    for (std::size_t k = 0, i = 0; k < 4; ++k) {
        if (k == q.largest) continue;
        result[k] = q.others[i++] / std::sqrt(2.0);
        square -= result[k] * result[k];
    }
    result[q.largest] = std::sqrt(std::max(square, 0.0));
    return result;
}

}  // namespace gs
