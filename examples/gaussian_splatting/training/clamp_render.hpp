// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/core/math.hpp>

namespace gs::train {

/// Clamps a render to [0, 1], the range of images. One index per value.
struct clamp_render {
    const float* from;
    float* to;
    WARPAGG_HD void operator()(std::size_t i) const {
        to[i] = warpagg::math::min(warpagg::math::max(from[i], 0.0f), 1.0f);
    }
};

}  // namespace gs::train
