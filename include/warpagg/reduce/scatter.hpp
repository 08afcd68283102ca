// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../policy.hpp"

namespace warpagg::reduce {

/// How many results a lane holds after `scatter`.
template <warp W>
WARPAGG_HD constexpr int held_after_scatter(int n) {
    return (n + static_cast<int>(W::size) - 1) / static_cast<int>(W::size);
}

/// Which of the N results the lane holds in slot k after `scatter`: its number with the bits reversed, plus
/// k W. None if that is N or more.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD value_t<W, unsigned> scattered_index(const W& w, int k) {
    using math::bit_reverse;
    const unsigned first = W::size * static_cast<unsigned>(k);
    if constexpr (W::size == 1) {
        return value_t<W, unsigned>(first);
    } else {
        constexpr unsigned unused = 32 - math::popcount(W::size - 1);  // bits of a lane's number
        return (bit_reverse(w.lane()) >> unused) + first;
    }
}

namespace detail {

/// Whether the lane is in the upper half of its 2 Distance lanes.
WARPAGG_EXEC_CHECK_DISABLE
template <unsigned Distance, warp W>
WARPAGG_HD mask_t<W> is_upper(const W& w) {
    if constexpr (requires { w.template is_upper<Distance>(); }) {
        return w.template is_upper<Distance>();
    } else {
        return (w.lane() & Distance) != 0u;
    }
}

/// One step over the slots from K on: of the M values that it holds, a lane keeps those at even places and
/// sends the others to its partner if its bit of `Distance` is clear, and the other way round if it is set. A
/// last value without a neighbour is combined by both. A recursion, not a loop: nvcc would split a loop on
/// `upper` and so put the shuffles into divergent branches.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, unsigned Distance, int M, int K, warp W, class V>
WARPAGG_HD void exchange(const W& w, V* v, const mask_t<W>& upper) {
    using math::select;
    if constexpr (2 * K + 1 < M) {
        const V keep = select(upper, v[2 * K + 1], v[2 * K]);
        const V send = select(upper, v[2 * K], v[2 * K + 1]);
        v[K] = Op::combine(keep, w.shfl_xor(send, Distance));
        exchange<Op, Distance, M, K + 1>(w, v, upper);
    } else if constexpr (2 * K < M) {
        v[K] = Op::combine(v[2 * K], w.shfl_xor(v[2 * K], Distance));
    }
}

WARPAGG_EXEC_CHECK_DISABLE
template <class Op, unsigned Distance, int M, warp W, class V>
WARPAGG_HD void scatter_from(const W& w, V* v) {
    if constexpr (Distance > 0) {
        exchange<Op, Distance, M, 0>(w, v, is_upper<Distance>(w));
        scatter_from<Op, Distance / 2, (M + 1) / 2>(w, v);
    }
}

}  // namespace detail

/// Combines each of the N values over the warp and leaves the results spread over the lanes: see
/// `scattered_index`. The tree is that of `shfl_down`, so the results have the same bits. Cost: about N - 1 +
/// log2(W / N) shuffles (N = 9: 12).
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class V, int N>
WARPAGG_HD void over_warp(scatter, const W& w, V (&v)[N]) {
    detail::scatter_from<Op, W::size / 2, N>(w, v);
}

}  // namespace warpagg::reduce
