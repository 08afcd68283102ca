// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gs {

/// What a synthetic scene shows, and how it was photographed. The defaults are what a matte world, cameras at
/// one distance and one exposure, and no noise come to.
struct synthetic_parameters {
    std::string world;
    double gloss = 0;     ///< how much surfaces reflect sun and sky, beside what they scatter: 0 to 1
    double exposure = 0;  ///< standard deviation of log2 of a photo's brightness, as displayed: 0 to 2
    double scales = 1;    ///< the farthest camera's distance over the nearest's: 1 to 16
    double distance = 1;  ///< of all cameras, in those of other scenes: 0.25 to 16
    double passers = 0;   ///< share of a photo that a disc covers which no other photo has: 0 to 0.5. Masked
    /// Relative noise of the inverse depths that its depth maps have, each with a scale and an offset of its
    /// own: 0 to 10. Negative: it has no maps.
    double depths = -1;
    double sky = 0;        ///< brightness of what no surface hides, which depends on direction alone: 0 to 1
    double points = 3000;  ///< of its surfaces: 1 to 100000
    double views = 48;     ///< of which as many are for training, spread over those there are: 1 to 48
    double fisheye = 0;    ///< degrees across the picture of such a lens; 0: a pinhole camera. 0 to 190
    double noise = 0;      ///< standard deviation of values in [0, 1] where a photo shows something: 0 to 0.5
};

/// From "WORLD", or "WORLD,gloss=0.5,noise=0.02" and so on. Throws `error` for a parameter that is none,
/// twice there, or out of its range; the world is looked at elsewhere.
synthetic_parameters parse_synthetic(const std::string& text);

}  // namespace gs
