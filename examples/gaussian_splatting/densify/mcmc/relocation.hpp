// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/exponential.hpp>
#include <warpagg/core/compiler.hpp>

#include "../../model/opacity.hpp"

namespace gs::train {

/// The parameters of each of the copies that replace one Gaussian.
struct relocated {
    double opacity;  ///< in (0, 1)
    double scale;    ///< factor of the Gaussian's scale, in (0, 1]
};

/// Returns the opacity and scale of `copies` equal Gaussians that together look like one Gaussian of
/// this opacity. Source: Kheradmand et al. 2024, equation 9. The equation's sum is alternating and
/// cancels for many copies. This function uses the identity 1/sqrt(k) = 2/sqrt(pi) * integral of
/// exp(-k s^2) over s > 0, which turns the sum into the integral of 1 - (1 - q exp(-s^2))^copies for
/// copies of opacity q. The trapezoidal rule integrates it to rounding errors. Preconditions:
/// `opacity` is in (0, 1), `copies` is positive. Cost: 120 exponentials and 60 logarithms.
WARPAGG_HD relocated relocate(double opacity, std::uint32_t copies) {
    if (copies == 1) return {opacity, 1};
    const double n = copies, each = 1 - glm::exp(glm::log(1 - opacity) / n);
    constexpr double step = 0.1, two_over_sqrt_pi = 1.1283791670955126;
    double sum = opacity / 2;
    for (int k = 1; k < 60; ++k) {
        const double s = k * step;
        sum += 1 - glm::exp(n * glm::log(1 - each * glm::exp(-s * s)));
    }
    return {each, opacity / (two_over_sqrt_pi * step * sum)};
}

}  // namespace gs::train
