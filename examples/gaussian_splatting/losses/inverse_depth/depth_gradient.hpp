// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <warpagg/warp/concept.hpp>

#include "../../image/depth_map.hpp"

namespace gs::train {

/// The gradient, by inverse depths that were drawn, of their mean distance from those of a depth map; pixels
/// that it does not know have none (Kerbl et al. 2024, hierarchical 3D Gaussians). One index a pixel.
struct depth_gradient {
    const float* drawn;
    const std::uint16_t* map;
    depth_fit fit;
    float weight;  ///< over the number of pixels
    std::size_t pixels;
    float* gradient;  ///< three planes, the last two of which are zero, as for a picture

    WARPAGG_HD void operator()(std::size_t i) const {
        // Nothing lies behind what is infinitely far.
        const float wanted = warpagg::math::max(fit.scale * static_cast<float>(map[i]) + fit.offset, 0.0f);
        const float apart = drawn[i] - wanted;
        const float slope = apart > 0 ? weight : apart < 0 ? -weight : 0.0f;
        gradient[i] = map[i] != 0 ? slope : 0.0f;
        gradient[i + pixels] = gradient[i + 2 * pixels] = 0;
    }
};

}  // namespace gs::train
