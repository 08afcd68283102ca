// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "accumulators.hpp"
#include "render/gradients/accumulator_set.hpp"

namespace gs::lab {

/// Handles one pixel per lane with one warp per patch, which walks over the whole list of the tile.
/// `SkipsIdle`: a warp whose lanes have no gradient computes no sums.
template <class Policy, bool SkipsIdle>
struct whole_lists {
    static constexpr bool supports_background_image = false;
    template <class Real, class Cut>
    using kernel = raster::blend_backward<Real, raster::pixel_a_lane<Cut>, false, Policy, SkipsIdle>;
};

/// Every lane issues its own atomics: the original kernel.
using per_lane_sums = whole_lists<warpagg::policy<warpagg::reduce::per_lane>, false>;
/// The paper, Figure 7: shuffles, then one lane's atomics, also in idle warps.
using reduce_sums = whole_lists<warpagg::policy<warpagg::reduce::shfl_down, warpagg::idle::add_zeros>, false>;
/// The paper, Figure 8: the same without the idle warps.
using reduce_skip_sums =
    whole_lists<warpagg::policy<warpagg::reduce::shfl_down, warpagg::idle::assume_busy>, true>;
/// Reduce-scatter and one contiguous atomic instruction.
using scatter_sums = whole_lists<warpagg::policy<warpagg::reduce::scatter, warpagg::idle::assume_busy>, true>;

/// All variants: the trainer's first, so that an `accumulator` means the same in both sets.
using lab_accumulators =
    raster::accumulator_set<raster::native_sums, raster::sums_kept_in<raster::fixed_sums>, per_lane_sums,
                            reduce_sums, reduce_skip_sums, scatter_sums,
                            raster::sums_kept_in<warpagg::accumulate::f64, false>,
                            raster::sums_kept_in<warpagg::accumulate::compensated, false>,
                            raster::sums_kept_in<warpagg::accumulate::binned<2>, false>,
                            raster::sums_kept_in<warpagg::accumulate::exact, false>>;

}  // namespace gs::lab
