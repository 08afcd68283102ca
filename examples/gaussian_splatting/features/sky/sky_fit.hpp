// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// The sky in the training images: smooth parts without points whose color depends on the direction alone,
/// so that the other images predict the color in each of them.
struct sky_fit {
    bool has_points = false;          ///< the scene has points; otherwise nothing was measured
    double share = 0;                 ///< part of the images' area predicted to within `sky_tolerance`
    double empty = 0;                 ///< part of their area that is smooth and has no points
    double brightness = 0;            ///< mean of the predicted part over its channels, in [0, 1]
    std::vector<float> coefficients;  ///< see `gaussians::sky`
};
inline constexpr double sky_tolerance = 0.06;  ///< root mean square over channels

/// Fits SH coefficients of degree 3 to cells of a 32nd of the images' longer side. Each image is predicted by
/// a fit without it. `brighter`: the relative brightness of each image, see `photo_brightness`; may be empty.
sky_fit fit_sky(const scene& of, const std::vector<double>& brighter);

}  // namespace gs::features
