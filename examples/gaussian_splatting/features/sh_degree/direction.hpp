// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "../../scene/scene_statistics.hpp"

namespace gs::features {

/// How much the colors of surface points depend on the direction from which they are seen.
struct direction_statistics {
    bool has_points = false;  ///< the scene has points
    std::size_t points = 0;   ///< points that tell
    /// By SH degree d: the mean square, in [0, 1] units, of an observation minus its prediction from the
    /// other observations of its point by spherical harmonics of degree d. Zeros if no point tells.
    std::array<double, 4> unexplained{};

    /// Whether enough points tell.
    bool is_known() const;
    /// The SH degree that colors need: 0 to 3. Where too few points tell, 3; but 0 where next to no point
    /// tells, because then the photos are too few or too far apart to separate view-dependent color from
    /// everything else.
    int degree() const;
};

/// Ridge regression per point on what exposure does not explain; each observation is left out of its own
/// prediction.
direction_statistics measure_direction(const scene_statistics& statistics);

/// The regression's part of `measure_direction`.
std::array<double, 4> unexplained_by_direction(const observed_points& points);

}  // namespace gs::features
