// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "depth/depth_evidence.hpp"
#include "../scene/observations.hpp"
#include "sky/sky_evidence.hpp"

namespace gs::effects {

/// What the photos say of the effects that a scene may call for. Without points there is nothing that photos
/// share.
struct evidence {
    bool has_points = false;  ///< the scene has some

    /// Exposures: by what factor photos have the same points brighter than others have them, as displayed;
    /// its logarithm to base 2. A photo's light has changed by about twice that.
    std::size_t exposure_points = 0;  ///< that tell of it
    double exposure_spread = 0;       ///< root mean square over the photos
    double exposure_error = 0;        ///< median standard error of a photo's
    std::vector<double> brighter;     ///< see `exposure_estimate`; none without such points

    /// Colour by direction, once exposures are taken out. `unexplained[d]`: the mean square of what is left
    /// of an observation, in [0, 1] units, when it is predicted from the point's others by spherical
    /// harmonics of degree d.
    std::size_t direction_points = 0;
    std::array<double, 4> unexplained{};

    /// How much larger a point is in one photo than in another: the median point's largest footprint of a
    /// pixel over its least.
    std::size_t scale_points = 0;
    double scale_ratio = 1;

    std::size_t photos = 0, masked_photos = 0;  ///< and of those for training that have a mask
    double masked_share = 0;                    ///< of all their pixels that masks leave out

    std::size_t fisheye_photos = 0;  ///< and of those that fisheye lenses took
    double widest = 0;               ///< degrees from corner to corner of the widest of these

    sky_evidence sky;
    depth_evidence depth;

    bool alpha = false;  ///< photos have transparent parts
};

evidence gather(const scene& of);
/// Only what the points say: of exposures, directions and scales.
evidence gather_from_points(const scene& of);

/// Parts of it.
/// @{
/// Of each photo, see `evidence`; those of all photos that share points have a mean of zero. Photos that
/// share too little with others have zero, and no error. Least squares over points and photos, with Huber's
/// weights, in 10 rounds of conjugate gradients.
struct exposure_estimate {
    std::vector<double> brighter, error;
};
exposure_estimate exposures(const std::vector<std::vector<observation>>& points, std::size_t views);
/// See `evidence::unexplained`. Ridge regression a point, each observation left out of its own prediction.
std::array<double, 4> unexplained_by_direction(const std::vector<std::vector<observation>>& points);
/// @}

}  // namespace gs::effects
