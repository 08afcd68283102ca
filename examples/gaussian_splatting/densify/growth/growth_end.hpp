// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../../core/iteration_plan.hpp"

namespace gs::train {

/// Returns the first iteration without growth of the number of Gaussians, by default: half of the
/// iterations, at most 15,000 (Kerbl et al. 2023). Without transparent photos it is at most 40
/// iterations per training view, or 3,500 if that is more, because Gaussians that are born later
/// mostly fit details of single photos.
inline int default_growth_end(const iteration_plan& iterations, int views, bool transparent) {
    constexpr int least = 3500, most = 15000;
    const int by_views = 40 * std::min(views, most / 40);
    return std::min(transparent ? most : std::max(least, by_views), iterations.milestone(0.5));
}

}  // namespace gs::train
