// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The reduction `reduce::cub`, which uses CUB; for comparison. In CUDA code, include this header in addition
/// to atomic.hpp.

#include <cub/warp/warp_reduce.cuh>

#include "../core/tags.hpp"
#include "../warp/cuda.hpp"

namespace warpagg {
namespace reduce {

/// Reduces each value by `cub::WarpReduce` and leaves the results in lane 0. Only for `cuda_warp`. Cost:
/// N log2(W) shuffles.
struct cub {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::first_lane;
};

/// Reduces N values per lane over the warp. Lane 0 holds the results afterwards.
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

inline namespace tags {
/// The tag `reduce::cub` as an object, for `policy{...}`.
WARPAGG_TAG reduce::cub cub{};
}  // namespace tags

}  // namespace warpagg
