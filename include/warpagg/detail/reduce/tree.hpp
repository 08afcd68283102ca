// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/tags.hpp"
#include "../../warp/concept.hpp"

namespace warpagg::reduce {

namespace detail {

WARPAGG_EXEC_CHECK_DISABLE
template <class Op, unsigned Distance, warp W, class V, int N>
WARPAGG_HD void down_from(const W& w, V (&v)[N]) {
    if constexpr (Distance > 0) {
        WARPAGG_UNROLL
        for (int i = 0; i < N; ++i) v[i] = Op::combine(v[i], w.shfl_down(v[i], Distance));
        down_from<Op, Distance / 2>(w, v);
    }
}

WARPAGG_EXEC_CHECK_DISABLE
template <class Op, unsigned Distance, warp W, class V, int N>
WARPAGG_HD void across_from(const W& w, V (&v)[N]) {
    if constexpr (Distance > 0) {
        WARPAGG_UNROLL
        for (int i = 0; i < N; ++i) v[i] = Op::combine(v[i], w.shfl_xor(v[i], Distance));
        across_from<Op, Distance / 2>(w, v);
    }
}

}  // namespace detail

/// Combines value(0) ... value(N - 1) over the warp by shuffles down, halving the distance in each step. Lane
/// 0 holds the results afterwards. Cost: N log2(W) shuffles. Source: the paper, Figure 1.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Values, class V, int N>
WARPAGG_HD void reduce_over_warp(shfl_down, const W& w, const Values& value, V (&results)[N]) {
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) results[i] = value(i);
    detail::down_from<Op, W::size / 2>(w, results);  // mutate: shfl_down_half_a_warp
}

/// Combines value(0) ... value(N - 1) in the tree of `shfl_down`. Every lane holds the results afterwards.
/// Cost: N log2(W) shuffles.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Values, class V, int N>
WARPAGG_HD void reduce_over_warp(butterfly, const W& w, const Values& value, V (&results)[N]) {
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) results[i] = value(i);
    detail::across_from<Op, W::size / 2>(w, results);
}

/// Combines value(0) ... value(N - 1) by `redux.sync`. Every lane holds the results afterwards. Cost: N
/// instructions, or those of `butterfly` on a model without `redux.sync`.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Values, class V, int N>
WARPAGG_HD void reduce_over_warp(redux, const W& w, const Values& value, V (&results)[N]) {
    using T = warpagg::scalar_t<V>;
    static_assert(std::is_integral_v<T> && sizeof(T) == 4,
                  "redux is for integers of 32 bits: take butterfly or scatter");
    if constexpr (requires { w.redux(Op{}, value(0)); }) {
        WARPAGG_UNROLL
        for (int i = 0; i < N; ++i) results[i] = w.redux(Op{}, value(i));
    } else {
        reduce_over_warp<Op>(butterfly{}, w, value, results);
    }
}

/// @cond deprecated
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class Reduce, warp W, class Values, class V, int N>
[[deprecated("use reduce_over_warp")]] WARPAGG_HD void over_warp(Reduce how, const W& w, const Values& value,
                                                                 V (&results)[N]) {
    reduce_over_warp<Op>(how, w, value, results);
}
/// @endcond

}  // namespace warpagg::reduce
