// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "../../scene/scene_statistics.hpp"

namespace gs::features {

/// Statistics on how the colors of surface points depend on the viewing direction.
struct direction_statistics {
    /// The smallest gain of a degree, relative to degree 0, and as a root mean square.
    static constexpr double least_share = 0.03, least_amplitude = 0.002;

    bool has_points = false;  ///< whether the scene has points
    std::size_t points = 0;   ///< number of points with enough observations
    /// For each SH degree d, the mean square of an observation minus its prediction from the other
    /// observations of its point by spherical harmonics of degree d. Colors are in [0, 1]. Zeros if
    /// `points` is 0.
    std::array<double, 4> unexplained{};

    /// Returns whether `points` is large enough for a decision.
    bool is_known() const;
    /// Returns the SH degree that colors need, 0 to 3. If `points` is too small for a decision,
    /// this is 3. If it is almost zero although the scene has points, this is 0: the photos are
    /// then too few or too far apart to separate view-dependent color from other effects.
    int degree() const;
};

/// Computes the statistics by ridge regression for each point, after differences of exposure are
/// removed. The prediction of an observation does not use that observation.
direction_statistics measure_direction(const scene_statistics& statistics);

/// Computes `direction_statistics::unexplained` by ridge regression.
std::array<double, 4> unexplained_by_direction(const observed_points& points);

/// Returns the observations that `measure_direction` compares, after differences of exposure are
/// removed. The footprints of a point are similar.
observed_points comparable_points(const scene_statistics& statistics);

/// Returns, for each point, the mean square by which an SH degree from 1 to 3 reduces the
/// difference between an observation and its prediction.
std::vector<double> explained_by_direction(const observed_points& points, int degree);

}  // namespace gs::features
