// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/tags.hpp"
#include "../../warp/concept.hpp"

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
        return (bit_reverse(w.lane()) >> unused) + first;              // mutate: scatter_second_row_lost
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
        return (w.lane() & Distance) != 0u;  // mutate: scatter_halves_swapped
    }
}

/// How many of n values a lane still holds after the step of `distance`, which halves them as those before
/// it.
template <warp W>
WARPAGG_HD constexpr int held_after_step(int n, unsigned distance) {
    for (unsigned d = W::size / 2; d >= distance; d /= 2) n = (n + 1) / 2;
    return n;
}

/// What the lane holds at place K after the step of Distance: of the values at 2K and 2K + 1 before, it keeps
/// the first and sends the other to its partner if its bit of Distance is clear, and the other way round if
/// it is set. A last value without a neighbor is combined by both. Each value is asked for when it is
/// needed, and a recursion has few of them at a time: on SIMD lanes, registers are fewer than values. No
/// loop, since nvcc would split one on `upper` and so put the shuffles into divergent branches.
WARPAGG_EXEC_CHECK_DISABLE
template <class V, class Op, unsigned Distance, int N, int K, warp W, class Values>
WARPAGG_HD V scattered(const W& w, const mask_t<W>* upper, const Values& value) {
    using math::select;
    if constexpr (Distance == W::size) {
        return value(K);
    } else {
        const V even = scattered<V, Op, 2 * Distance, N, 2 * K>(w, upper + 1, value);
        if constexpr (2 * K + 1 < held_after_step<W>(N, 2 * Distance)) {
            const V odd = scattered<V, Op, 2 * Distance, N, 2 * K + 1>(w, upper + 1, value);
            // mutate: scatter_sends_what_it_keeps
            return Op::combine(select(*upper, odd, even), w.shfl_xor(select(*upper, even, odd), Distance));
        } else {
            return Op::combine(even, w.shfl_xor(even, Distance));  // mutate: scatter_loses_last_value
        }
    }
}

WARPAGG_EXEC_CHECK_DISABLE
template <class Op, int K, warp W, class Values, class V, int N>
WARPAGG_HD void scatter_from(const W& w, const mask_t<W>* upper, const Values& value, V (&results)[N]) {
    if constexpr (K < held_after_scatter<W>(N)) {
        results[K] = scattered<V, Op, 1, N, K>(w, upper, value);
        scatter_from<Op, K + 1>(w, upper, value, results);
    }
}

}  // namespace detail

/// Combines value(0) ... value(N - 1) over the warp and leaves the results spread over the lanes: see
/// `scattered_index`. `results` has N places, of which the first `held_after_scatter` are filled. The tree is
/// that of `shfl_down`, so the results have the same bits. Cost: about N - 1 + log2(W / N) shuffles (N = 9:
/// 12).
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Values, class V, int N>
WARPAGG_HD void reduce_over_warp(scatter, const W& w, const Values& value, V (&results)[N]) {
    static_assert(W::size <= 32);
    using detail::is_upper;
    const mask_t<W> upper[] = {is_upper<1>(w), is_upper<2>(w), is_upper<4>(w), is_upper<8>(w),
                               is_upper<16>(w)};
    detail::scatter_from<Op, 0>(w, upper, value, results);
}

}  // namespace warpagg::reduce
