// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "fixed_effects.hpp"
#include "observations.hpp"

namespace gs {

/// How much darker the same points look in photos that show them farther from the center. A strength is the
/// natural logarithm of the brightness at the principal point relative to that at the farthest corner. It
/// assumes that the logarithm falls in proportion to `square_radius`. It is extrapolated if no points are
/// near corners.
struct lens_falloff {
    static constexpr double least_strength = 0.05;  ///< of a clear falloff
    static constexpr double least_errors = 5;       ///< of a clear falloff, in standard errors
    /// Strength in each test relative to the whole. It may be smaller by this number of standard errors.
    static constexpr double least_agreement = 0.3, test_errors = 3;

    std::size_t points = 0;            ///< number of compared points
    estimated strength;                ///< of all points and channels
    std::array<double, 3> channels{};  ///< strengths of red, green and blue

    /// Tests by which a falloff differs from other causes. A lens darkens all sides of the image alike.
    std::array<estimated, 4> sides{};  ///< strengths toward the right, left, bottom and top of photos
    /// Strength if the color of each point may also change linearly with the viewing direction, as that of
    /// glossy and of unevenly lit surfaces does.
    estimated for_direction;

    /// For each tenth of the distance to the farthest corner that has enough observations, the mean distance,
    /// and the brightness relative to the center.
    std::vector<std::pair<double, double>> profile{};

    /// Returns whether the strength is large and significant.
    bool is_strong() const;
    /// Returns whether there is a falloff: it is strong, and no test contradicts it.
    bool is_clear() const;
    /// Returns the factors by which red, green and blue are darker at a squared radius.
    std::array<double, 3> at(double square_radius) const;
};

/// Estimates the falloff that the lenses of all training photos have in common, by least squares over points
/// and photos with Tukey weights. A point has one brightness, and each photo has its own exposure. `points`
/// holds the observations of each point. Panoramas do not count. Standard errors allow for residuals that
/// the points of a photo have in common. Cost: about 2000 passes over the observations.
lens_falloff estimate_falloff(const scene& of, observed_points points);

/// Removes a falloff from the colors of observations.
void remove_falloff(const scene& of, const lens_falloff& falloff, observed_points& points);

}  // namespace gs
