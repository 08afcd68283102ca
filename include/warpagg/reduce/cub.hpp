// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The reduction `reduce::cub`, for comparison: CUB's. Include it beside atomic.hpp, in CUDA code.

#include <cub/warp/warp_reduce.cuh>

#include "../core/tags.hpp"
#include "../warp/cuda.hpp"

namespace warpagg {
namespace reduce {

/// CUB's `WarpReduce`, value by value; lane 0 ends with the results. Only on `cuda_warp`.
struct cub {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::first_lane;
};

/// Cost: N log2(W) shuffles.
template <class Op, class Values, class T, int N>
__device__ __forceinline__ void reduce_over_warp(cub, const cuda_warp&, const Values& value,
                                                 T (&results)[N]) {
    using machine = ::cub::WarpReduce<T>;
    static_assert(sizeof(typename machine::TempStorage) <= 1, "a whole warp reduces by shuffles alone");
    typename machine::TempStorage nothing;
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i)
        results[i] =
            machine(nothing).Reduce(value(i), [](const T& a, const T& b) { return Op::combine(a, b); });
}

}  // namespace reduce

/// The tag as an object, for `policy{...}`.
WARPAGG_TAG reduce::cub cub{};

}  // namespace warpagg
