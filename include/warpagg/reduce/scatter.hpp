// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../simt/warp.hpp"

namespace warpagg::reduce {

/// How many sums a lane holds after `sum_scatter`.
template <warp W>
constexpr int held_after_scatter(int n) {
    return (n + static_cast<int>(W::size) - 1) / static_cast<int>(W::size);
}

/// Which of the N sums the lane holds in slot k after `sum_scatter`: its number with the bits reversed, plus
/// k W. None if that is N or more.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD value_t<W, unsigned> scattered_index(const W& w, int k) {
    using math::select;
    const value_t<W, unsigned> lane = w.lane();
    value_t<W, unsigned> index(W::size * static_cast<unsigned>(k));
    WARPAGG_UNROLL
    for (unsigned from = W::size / 2, to = 1; from > 0; from /= 2, to *= 2)
        index += select((lane & from) != 0u, value_t<W, unsigned>(to), value_t<W, unsigned>(0u));
    return index;
}

namespace detail {

/// One step over the slots from K on: of the M values that it holds, a lane keeps those at even places and
/// sends the others to its partner if its bit of `Distance` is clear, and the other way round if it is set. A
/// last value without a neighbour is summed by both. A recursion, not a loop: nvcc would split a loop on
/// `upper` and so put the shuffles into divergent branches.
WARPAGG_EXEC_CHECK_DISABLE
template <unsigned Distance, int M, int K, warp W, class V>
WARPAGG_HD void exchange(const W& w, V* v, const mask_t<W>& upper) {
    using math::select;
    if constexpr (2 * K + 1 < M) {
        const V keep = select(upper, v[2 * K + 1], v[2 * K]);
        const V send = select(upper, v[2 * K], v[2 * K + 1]);
        v[K] = keep + w.shfl_xor(send, Distance);
        exchange<Distance, M, K + 1>(w, v, upper);
    } else if constexpr (2 * K < M) {
        v[K] = v[2 * K] + w.shfl_xor(v[2 * K], Distance);
    }
}

WARPAGG_EXEC_CHECK_DISABLE
template <unsigned Distance, int M, warp W, class V>
WARPAGG_HD void scatter_from(const W& w, V* v) {
    if constexpr (Distance > 0) {
        exchange<Distance, M, 0>(w, v, (w.lane() & Distance) != 0u);
        scatter_from<Distance / 2, (M + 1) / 2>(w, v);
    }
}

}  // namespace detail

/// Sums each of the N values over the warp and leaves the sums spread over the lanes: see `scattered_index`.
/// The tree is that of `sum_shfl_down`, so the sums have the same bits. Cost: about N - 1 + log2(W / N)
/// shuffles (N = 9: 12).
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class V, int N>
WARPAGG_HD void sum_scatter(const W& w, V (&v)[N]) {
    detail::scatter_from<W::size / 2, N>(w, v);
}

}  // namespace warpagg::reduce
