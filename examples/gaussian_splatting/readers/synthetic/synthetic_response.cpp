// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic_response.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gs {

double synthetic_response(const synthetic_parameters& how, double x) {
    const double clamped = std::clamp(x, 0.0, 1.0);
    const double sine = std::sin(0.5 * std::numbers::pi * clamped);
    return (1 - how.response) * clamped + how.response * sine * sine;
}

}  // namespace gs
