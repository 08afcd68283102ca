// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/lane_math.hpp"

namespace gs {

/// Returns the opacity with this logit.
template <class Real>
WARPAGG_HD Real sigmoid(Real logit) {
    return 1 / (1 + exponential(-logit));
}

/// Returns the logit of an opacity in [0, 1]. The result is finite, because 0 and 1 are replaced by
/// the smallest normal float and by 1 - 2^-24.
inline float logit(float opacity) {
    constexpr double least = std::numeric_limits<float>::min(), most = 1 - 0x1p-24;
    const double p = std::clamp<double>(opacity, least, most);
    return static_cast<float>(std::log(p) - std::log1p(-p));
}

}  // namespace gs
