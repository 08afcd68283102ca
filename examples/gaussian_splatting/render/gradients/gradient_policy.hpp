// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace gs {

/// How the backward blending adds up its gradients: compiled variants of one kernel. Each step down the
/// ladder changes one thing.
enum class gradient_policy {
    per_lane,     ///< the original: a pixel a lane, every pixel its own atomics
    reduce,       ///< the paper, Figure 7: shuffles and lane 0, idle warps included
    reduce_skip,  ///< the paper, Figure 8: the same, idle warps skipped
    scatter,      ///< ours: reduce-scatter and one contiguous atomic instruction
    split,        ///< and several pixels a lane, long lists split over warps
    // The same, with what warps come to added up in other than floats: see `warpagg::accumulate`.
    f64,
    compensated,
    fixed,
    binned,
    exact
};

inline constexpr std::array<std::string_view, 10> gradient_policy_names{
    "per-lane", "reduce",      "reduce-skip", "scatter", "split",
    "f64",      "compensated", "fixed",       "binned",  "exact"};

/// Whether its sums have the same bits whatever warp comes first.
constexpr bool is_repeatable(gradient_policy p) {
    return p == gradient_policy::fixed || p == gradient_policy::binned || p == gradient_policy::exact;
}

/// Whether it is there for a picture before a sky as well.
constexpr bool knows_skies(gradient_policy p) {
    return p == gradient_policy::split || p == gradient_policy::fixed;
}

}  // namespace gs
