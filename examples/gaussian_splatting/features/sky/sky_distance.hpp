// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sky_fit.hpp"

namespace gs::features {

/// Tells whether a predicted sky is a near surface, such as a smooth wall. A wall looks like a sky in
/// each photo. The photos disagree about a wall at infinity, because its edges and its shading have
/// parallax.
///
/// The comparisons are looks from the camera of another photo at a square of the predicted sky, once
/// at infinity and once at a finite distance. In both cases, the other photo must either show the
/// same color, or something different without points. Points may belong to a surface in front of the
/// sky, so squares near points contradict nothing.
struct sky_distance {
    double distance = 0;   ///< from the mean of the cameras, in units of `scene::extent`; 0 if unknown
    double near_only = 0;  ///< share of comparisons that match at `distance` alone
    double far_only = 0;   ///< share of comparisons that match at infinity alone

    static constexpr double largest_excess = 0.02;  ///< of `near_only` over `far_only`, for a sky

    /// Returns whether `distance` explains the photos clearly better than infinity.
    bool is_near() const { return near_only - far_only > largest_excess; }
};

/// Returns the strength of the falloff without which most looks at infinity show the same color: 0 to 0.8 in
/// steps of 0.1, see `lens_falloff`. Parameters: see `measure_distance`. Cost: nine looks at up to 1000
/// squares from each camera.
double strength_of_falloff(const scene& of, const std::vector<photo_cells>& cells, const sky_fit& fit,
                           const std::vector<double>& brighter);

/// Compares the predicted sky between the training photos, and returns the finite distance with the
/// largest difference of both shares. `cells`, `fit` and `brighter` are from `divide_photos` and
/// `fit_sky`. Cost: looks at up to 4000 squares from each camera.
sky_distance measure_distance(const scene& of, const std::vector<photo_cells>& cells, const sky_fit& fit,
                              const std::vector<double>& brighter);

}  // namespace gs::features
