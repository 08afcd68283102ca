// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "fixed_effects.hpp"
#include "observations.hpp"

namespace gs {

/// How the color of the same points in photos of different exposure differs from a multiple. A camera with
/// the response R shows a point of brightness c in a photo of exposure e as R(e c). If R is a power, the
/// logarithm of this is a sum of a constant per point and a constant per photo. Otherwise, it has a
/// further part, which depends on the brightness that the sum predicts.
struct tone_response {
    static constexpr double least_strength = 0.01;  ///< of a clear response
    static constexpr double least_errors = 5;       ///< of a clear response, in standard errors
    /// Strength of a half in the other half. It must be `least_errors_of_half` standard errors, too.
    static constexpr double least_agreement = 0.3, least_errors_of_half = 3;

    std::size_t points = 0;  ///< number of compared points
    /// The logarithm of R(y) / y is t0 y + t1 y^2 and a constant.
    std::array<double, 2> terms{};
    /// The root mean square of the further part, relative to the brightness.
    double strength = 0;
    /// The further part that one half of the photos finds, as a multiple of its size in the other half, in
    /// both directions. It is 1 if both agree and 0 if they have nothing in common.
    std::array<estimated, 2> halves{};

    /// Returns how many standard errors the strength is.
    double errors() const;
    /// Returns whether there is a response: it is large and significant, and both halves show it.
    bool is_clear() const;
    /// Returns R(x), where R(1) is 1.
    double at(double x) const;
};

/// Estimates the response that the cameras of all training photos have in common, from all color channels, by
/// least squares over points and photos with Tukey weights. `points` holds the observations of each point.
/// Panoramas do not count. Nearly black and nearly saturated colors do not count either. The prediction
/// decides which ones these are, because noise would otherwise decide. Cost: about 3000 passes over the
/// observations.
tone_response estimate_response(const scene& of, observed_points points);

}  // namespace gs
