// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/lane_math.hpp"

namespace gs {

/// An opacity from its logit.
template <class Real>
WARPAGG_HD Real sigmoid(Real logit) {
    return 1 / (1 + exponential(-logit));
}

/// The logit of an opacity in [0, 1]: always finite, since 0 and 1 count as the floats next to them.
inline float logit(float opacity) {
    constexpr double least = std::numeric_limits<float>::min(), most = 1 - 0x1p-24;
    const double p = std::clamp<double>(opacity, least, most);
    return static_cast<float>(std::log(p) - std::log1p(-p));
}

}  // namespace gs
