// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../render/geometry/splat.hpp"
#include "../../render/project/project_backward.hpp"

namespace gs::train {

/// The variation of a Gaussian's color between views. Each pixel counts with the Gaussian's weight
/// w in it, alpha times transmittance. The variation bounds the error if the Gaussian takes its
/// mean color: if the colors of Gaussians i change by d_i, a pixel changes by the sum of w_i d_i.
/// All w_i of a pixel sum to at most 1, so the square of that change is at most the sum of w_i
/// d_i^2 (Jensen's inequality). Therefore the squared changes of all pixels sum to at most the sum
/// of the Gaussians' `squares`.
struct sh_error {
    float weight;   ///< sum of w over pixels and views
    float mean[3];  ///< mean color
    float squares;  ///< sum of w (color - mean)^2 over pixels, views and channels
};

/// Adds a view to the errors. Source: the algorithm of West 1979. One index per Gaussian.
struct add_sh_error {
    const raster::splat<float>* splats;
    const std::uint32_t* tiles;
    const float* sums;  ///< sums of w: see `score_views::sum_scores`, with scores of 1
    sh_error* errors;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (tiles[i] == 0) return;
        const float weight = sums[i * raster::record_stride + raster::sum_red];
        if (!(weight > 0)) return;
        sh_error& to = errors[i];
        const float color[3] = {splats[i].red, splats[i].green, splats[i].blue};
        to.weight += weight;
        for (int c = 0; c < 3; ++c) {
            const float off = color[c] - to.mean[c];
            to.mean[c] += weight / to.weight * off;
            to.squares += weight * off * (color[c] - to.mean[c]);
        }
    }
};

/// Sets values to 1. One index per value.
struct make_one {
    float* values;
    WARPAGG_HD void operator()(std::size_t i) const { values[i] = 1; }
};

}  // namespace gs::train
