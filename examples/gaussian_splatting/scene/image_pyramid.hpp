// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "../core/parallel.hpp"
#include "downsample.hpp"

namespace gs {

/// Returns the views at `downscales` smaller sizes, with sides divided by 2, 4, 8 and so on. Runs
/// in parallel.
inline std::vector<std::vector<view>> downsampled_levels(std::span<const view> views, int downscales) {
    std::vector<std::vector<view>> levels(static_cast<std::size_t>(downscales),
                                          std::vector<view>(views.size()));
    for_each_in_parallel(levels.size() * views.size(), [&](std::size_t i) {
        const std::size_t level = i / views.size(), which = i % views.size();
        levels[level][which] = downsampled(views[which], 2 << level);
    });
    return levels;
}

}  // namespace gs
