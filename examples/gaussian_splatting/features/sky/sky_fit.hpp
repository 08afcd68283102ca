// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "../../scene/scene.hpp"
#include "sky_cells.hpp"

namespace gs::features {

/// The sky in the training images: smooth parts without points, whose color depends only on the
/// direction. The other images therefore predict the color of such a part.
struct sky_fit {
    bool has_points = false;          ///< whether the scene has points; if not, the rest is 0
    double share = 0;                 ///< share of the images' area predicted to `sky_tolerance`
    double empty = 0;                 ///< share of their area that is smooth and has no points
    double brightness = 0;            ///< mean of the predicted part over its channels, in [0, 1]
    std::vector<float> coefficients;  ///< see `gaussians::sky`
    /// The predicted squares of each training image: indices into `photo_cells::cells`, or empty
    /// without points.
    std::vector<std::vector<std::uint32_t>> predicted;
};
inline constexpr double sky_tolerance = 0.06;  ///< root mean square over channels

/// Fits SH coefficients of degree 3 to the smooth squares without points. The prediction of each
/// image uses a fit without that image. `cells` are the squares from `divide_photos`. `brighter` is
/// the relative brightness of each image, see `photo_brightness`, or empty.
sky_fit fit_sky(const scene& of, const std::vector<photo_cells>& cells, const std::vector<double>& brighter);

}  // namespace gs::features
