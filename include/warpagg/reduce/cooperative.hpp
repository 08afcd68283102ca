// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The reduction `reduce::cooperative`, which uses cooperative groups; for comparison. In CUDA code, include
/// this header in addition to atomic.hpp.

#include <cooperative_groups.h>
#include <cooperative_groups/reduce.h>

#include "../core/tags.hpp"
#include "../warp/cuda.hpp"

namespace warpagg {
namespace reduce {

/// Reduces each value by `cooperative_groups::reduce` and leaves the results in every lane. Only for
/// `cuda_warp`. Cost: N log2(W) shuffles.
struct cooperative {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};

/// Reduces N values per lane over the warp. Every lane holds the results afterwards.
template <class Op, class Values, class T, int N>
__device__ __forceinline__ void reduce_over_warp(cooperative, const cuda_warp&, const Values& value,
                                                 T (&results)[N]) {
    namespace groups = ::cooperative_groups;
    const auto warp = groups::tiled_partition<32>(groups::this_thread_block());
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i)
        results[i] = groups::reduce(warp, value(i), [](const T& a, const T& b) { return Op::combine(a, b); });
}

}  // namespace reduce

inline namespace tags {
/// The tag `reduce::cooperative` as an object, for `policy{...}`.
WARPAGG_TAG reduce::cooperative cooperative{};
}  // namespace tags

}  // namespace warpagg
