// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../render/project/geometry.hpp"
#include "../../render/project/project_backward.hpp"
#include "../../render/project/splat.hpp"

namespace gs::train {

/// How much the colour of a Gaussian differs between views, each pixel of each weighed by the share w that
/// the Gaussian has in it: what would change if it had its mean colour everywhere. Where Gaussians i of a set
/// D change by d_i, a pixel changes by the sum of w_i d_i, and since all its w are at most 1 together, the
/// square of that is at most the sum of w_i d_i^2 (Jensen's inequality). So if each in D gets its mean
/// colour, the squares of what all values of the views' pictures change by are at most the sum of D's
/// `squares`, together.
struct colour_spread {
    float weight;   ///< sum of w over pixels and views
    float mean[3];  ///< colour
    float squares;  ///< sum of w (colour - mean)^2, over channels as well
};

/// Adds a view that was drawn, by the algorithm of West 1979: one index a Gaussian.
struct note_colours {
    const raster::splat<float>* splats;
    const std::uint32_t* tiles;
    const float* sums;  ///< see `project_backward`, of a picture whose gradient is one everywhere
    colour_spread* spreads;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (tiles[i] == 0) return;
        const float weight = sums[i * raster::record_stride + raster::sum_red];
        if (!(weight > 0)) return;
        colour_spread& to = spreads[i];
        const float colour[3] = {splats[i].red, splats[i].green, splats[i].blue};
        to.weight += weight;
        for (int c = 0; c < 3; ++c) {
            const float off = colour[c] - to.mean[c];
            to.mean[c] += weight / to.weight * off;
            to.squares += weight * off * (colour[c] - to.mean[c]);
        }
    }
};

/// One index a value.
struct make_one {
    float* values;
    WARPAGG_HD void operator()(std::size_t i) const { values[i] = 1; }
};

}  // namespace gs::train
