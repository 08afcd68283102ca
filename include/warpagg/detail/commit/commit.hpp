// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/tags.hpp"
#include "../../warp/concept.hpp"
#include "../accumulate/decompose.hpp"
#include "../destination.hpp"
#include "../reduce/scatter.hpp"

namespace warpagg::commit {

namespace detail {

/// Is true if the types allow one atomic instruction per group of neighbors.
template <class Op, class Commit, class W, class Dst, class V>
inline constexpr bool packs = false;
template <operation::is_sum Op, unsigned K, class W, class T>
inline constexpr bool packs<Op, packed<K>, W, contiguous_record<T>, T> = requires(const W& w, T* to,
                                                                                  const T* v, bool active) {
    w.template packs<K>(to);
    w.template atomic_add_packed<K>(Op{}, to, v, active);
};

/// Commits v[I] to v[N - 1] of active lanes in groups of K, and the remainder in smaller groups.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, unsigned K, int I, warp W, class T, int N>
WARPAGG_HD void by_groups(const W& w, T* to, const T (&v)[N], bool active) {
    constexpr int group = static_cast<int>(K);
    if constexpr (I + group <= N) {
        w.template atomic_add_packed<K>(Op{}, to + I, v + I, active);  // mutate: packed_first_values_again
        by_groups<Op, K, I + group>(w, to, v, active);
    } else if constexpr (I < N) {  // mutate: packed_remainder_lost
        by_groups<Op, K / 2, I>(w, to, v, active);
    }
}

}  // namespace detail

/// Returns whether `packed<K>` applies to this record. The result is uniform.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class Commit, class V, warp W, class Dst>
WARPAGG_HD bool is_packed(const W& w, Dst dst) {
    if constexpr (detail::packs<Op, Commit, W, Dst, V>) {
        return w.template packs<Commit::neighbors>(dst(0));  // mutate: packed_where_not_aligned
    } else {
        return false;
    }
}

/// Commits each active lane's own N values. Cost: N atomic instructions, or about N / K where
/// `packed<K>` applies.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class Commit, warp W, class Dst, class V, int N>
WARPAGG_HD void each_lane(const W& w, Dst dst, const V (&v)[N], const mask_t<W>& active) {
    if constexpr (detail::packs<Op, Commit, W, Dst, V>) {
        if (is_packed<Op, Commit, V>(w, dst)) {
            detail::by_groups<Op, Commit::neighbors, 0>(w, dst(0), v, active);
            return;
        }
    }
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i)
        warpagg::detail::commit_value<Op>(w, dst, value_t<W, unsigned>(static_cast<unsigned>(i)), v[i],
                                          active);
}

/// Commits each active lane's own values to fields, each as a record of its own.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class Commit, int I = 0, warp W, class T, int First, int... Rest, class V, int N>
WARPAGG_HD void each_lane(const W& w, const field_list<T, First, Rest...>& dst, const V (&v)[N],
                          const mask_t<W>& active) {
    V own[First];
    WARPAGG_UNROLL
    for (int i = 0; i < First; ++i) own[i] = v[I + i];  // mutate: fields_first_values_again
    each_lane<Op, Commit>(w, contiguous_record<T>{dst.first}, own, active);
    if constexpr (sizeof...(Rest) > 0) each_lane<Op, Commit, I + First>(w, dst.rest, v, active);
}

/// Commits N uniform values: lane i commits v[i]. Cost: one atomic instruction per W values.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Dst, class V, int N>
WARPAGG_HD void own_value(const W& w, Dst dst, const V (&v)[N]) {
    using math::select;
    WARPAGG_UNROLL
    for (int base = 0; base < N; base += static_cast<int>(W::size)) {
        const auto index = w.lane() + static_cast<unsigned>(base);
        V own = v[base];
        for (int i = base + 1; i < N && i < base + static_cast<int>(W::size); ++i)
            // mutate: contiguous_value_of_neighbor
            own = select(index == static_cast<unsigned>(i), v[i], own);
        // mutate: contiguous_one_lane_too_few
        warpagg::detail::commit_value<Op>(w, dst, index, own, index < static_cast<unsigned>(N));
    }
}

/// Commits the results of `scatter` from the lanes that hold them. Cost: one atomic instruction per W
/// values.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Dst, class V, int N>
WARPAGG_HD void scattered(const W& w, Dst dst, const V (&v)[N]) {
    constexpr int held = reduce::held_after_scatter<W>(N);
    WARPAGG_UNROLL
    for (int k = 0; k < held; ++k) {
        const auto index = reduce::scattered_index(w, k);
        // mutate: scattered_one_lane_too_many
        warpagg::detail::commit_value<Op>(w, dst, index, v[k], index < static_cast<unsigned>(N));
    }
}

/// Commits the results of a reduction from the lanes that hold them.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class Reduce, class Commit, warp W, class Dst, class V, int N>
WARPAGG_HD void results(const W& w, Dst dst, const V (&v)[N]) {
    if constexpr (Reduce::placement == reduce::result_placement::spread) {
        scattered<Op>(w, dst, v);
    } else if constexpr (std::is_same_v<Commit, contiguous>) {
        own_value<Op>(w, dst, v);
    } else {
        each_lane<Op, Commit>(w, dst, v, w.lane() == 0u);  // mutate: scalar_by_lane_1
    }
}

}  // namespace warpagg::commit
