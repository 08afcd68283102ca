// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// What the training photos show of a sky: smooth parts in which the scene has no points, whose colors
/// depend on the direction alone, so that the other photos tell what one photo has there.
struct sky_fit {
    bool is_asked = false;            ///< the scene has points
    double share = 0;                 ///< of the photos' area that other photos predict to `sky_tolerance`
    double empty = 0;                 ///< of their area: smooth, and without points
    double brightness = 0;            ///< of the predicted part, mean of its channels in [0, 1]
    std::vector<float> coefficients;  ///< as `gaussians::sky`
};
inline constexpr double sky_tolerance = 0.06;  ///< root mean square over channels

/// By cells of a 32nd of the photos' longer side, and a fit of degree 3 that has each photo left out of its
/// own prediction. `brighter`: of each photo, see `evidence`; or nothing.
sky_fit fit_sky(const scene& of, const std::vector<double>& brighter);

}  // namespace gs::features
