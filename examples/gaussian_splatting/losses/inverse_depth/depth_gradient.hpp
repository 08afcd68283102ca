// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <warpagg/warp/concept.hpp>

#include "../../image/depth_map.hpp"

namespace gs::train {

/// Computes the gradient of `weight` times the sum over all pixels of |d - (scale m + offset)| with
/// respect to the rendered inverse depths d; m are the values of a depth map. The gradient is zero
/// at pixels without a value, and its magnitude is at most `weight`. One index per pixel. Source:
/// Kerbl et al. 2024 (hierarchical 3D Gaussians).
struct depth_gradient {
    const float* render;
    const std::uint16_t* target;  ///< values of the depth map; 0 if the depth is unknown
    depth_fit fit;
    float weight;
    std::size_t pixels;
    float* gradient;  ///< three planes, as for an image; the last two are zero

    WARPAGG_HD void operator()(std::size_t i) const {
        // A negative inverse depth would lie beyond infinity.
        const float expected =
            warpagg::math::max(fit.scale * static_cast<float>(target[i]) + fit.offset, 0.0f);
        const float difference = render[i] - expected;
        const float slope = difference > 0 ? weight : difference < 0 ? -weight : 0.0f;
        gradient[i] = target[i] != 0 ? slope : 0.0f;
        gradient[i + pixels] = gradient[i + 2 * pixels] = 0;
    }
};

}  // namespace gs::train
