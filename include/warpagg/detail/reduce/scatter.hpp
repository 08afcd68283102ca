// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/tags.hpp"
#include "../../warp/concept.hpp"

namespace warpagg::reduce {

/// Returns how many results a lane holds at most after a `scatter` of n values: ceil(n / W).
template <warp W>
WARPAGG_HD constexpr int held_after_scatter(int n) {
    return (n + static_cast<int>(W::size) - 1) / static_cast<int>(W::size);
}

/// Returns the index of the result that the lane holds in slot k after `scatter`: the lane's number with its
/// bits reversed, plus k W. If the index is N or more, the slot holds no result.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD value_t<W, unsigned> scattered_index(const W& w, int k) {
    using math::bit_reverse;
    const unsigned first = W::size * static_cast<unsigned>(k);
    if constexpr (W::size == 1) {
        return value_t<W, unsigned>(first);
    } else {
        constexpr unsigned unused = 32 - math::popcount(W::size - 1);  // bits above a lane's number
        return (bit_reverse(w.lane()) >> unused) + first;              // mutate: scatter_second_row_lost
    }
}

namespace detail {

/// Returns whether the lane is in the upper half of its group of 2 Distance lanes.
WARPAGG_EXEC_CHECK_DISABLE
template <unsigned Distance, warp W>
WARPAGG_HD mask_t<W> is_upper(const W& w) {
    if constexpr (requires { w.template is_upper<Distance>(); }) {
        return w.template is_upper<Distance>();
    } else {
        return (w.lane() & Distance) != 0u;  // mutate: scatter_halves_swapped
    }
}

/// Returns how many of n values a lane still holds after the step of `distance`. Each step from W / 2 down
/// to `distance` halves them.
template <warp W>
WARPAGG_HD constexpr int held_after_step(int n, unsigned distance) {
    for (unsigned d = W::size / 2; d >= distance; d /= 2) n = (n + 1) / 2;
    return n;
}

/// Returns the value at place K after the step of Distance. The step takes the values at 2K and 2K + 1: a
/// lower lane keeps the first and sends the second to its partner, an upper lane does the opposite. If 2K is
/// the last place, both lanes combine its value. The recursion reads each value when it needs it and holds
/// few at a time, because SIMD values outnumber the registers. It is no loop, because nvcc would split a loop
/// on `upper` and put the shuffles into divergent branches.
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
/// `scattered_index`. It fills the first `held_after_scatter` of the N elements of `results`. It combines in
/// the tree of `shfl_down`, so the results have the same bits. Cost: about N - 1 + log2(W / N) shuffles (12
/// for N = 9 on 32 lanes).
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Values, class V, int N>
WARPAGG_HD void reduce_over_warp(scatter, const W& w, const Values& value, V (&results)[N]) {
    using detail::is_upper;
    const mask_t<W> upper[] = {is_upper<1>(w), is_upper<2>(w),  is_upper<4>(w),
                               is_upper<8>(w), is_upper<16>(w), is_upper<32>(w)};
    detail::scatter_from<Op, 0>(w, upper, value, results);
}

}  // namespace warpagg::reduce
