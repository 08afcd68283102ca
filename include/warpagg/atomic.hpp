// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// warpagg: a warp sums the values its lanes hold and touches memory once, instead of once per lane; and not
/// even that when no lane has anything to add. This is the one header to include: under nvcc it brings
/// `cuda::warp`, and `simt/lanes.hpp` and `simt/serial.hpp` bring the emulators.

#include "commit/commit.hpp"
#include "commit/destination.hpp"
#include "policy.hpp"
#include "reduce/scatter.hpp"
#include "reduce/tree.hpp"
#include "simt/warp.hpp"
#if defined(__CUDACC__)
#include "simt/cuda.hpp"
#endif

namespace warpagg {

/// True if no lane of the warp is active, in every lane alike; so that a whole warp can `continue` together.
/// All lanes call it. Cost: one vote. Source: the paper, Figure 8, lines 18 to 22.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD bool skip_if_warp_idle(const W& w, const mask_t<W>& active) {
    return !w.any(active);
}

namespace detail {

WARPAGG_EXEC_CHECK_DISABLE
template <class Policy, warp W, class Dst, class V, int N>
WARPAGG_HD void reduce_and_commit(const W& w, Dst dst, const V (&v)[N], const mask_t<W>& active) {
    using math::select;  // and by its arguments, that of SIMD lanes
    V sums[N];
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) sums[i] = select(active, v[i], V{});  // a NaN of an inactive lane ends here
    if constexpr (std::is_same_v<typename Policy::reduce, reduce::scatter>) {
        reduce::sum_scatter(w, sums);
        for (int k = 0; k < reduce::held_after_scatter<W>(N); ++k) {
            const auto index = reduce::scattered_index(w, k);
            w.atomic_add(dst, index, sums[k], index < static_cast<unsigned>(N));
        }
    } else if constexpr (std::is_same_v<typename Policy::reduce, reduce::shfl_down>) {
        reduce::sum_shfl_down(w, sums);
        commit::first_lane(w, dst, sums);
    } else {
        reduce::sum_butterfly(w, sums);
        if constexpr (std::is_same_v<typename Policy::commit, commit::contiguous>) {
            commit::own_value(w, dst, sums);
        } else {
            commit::first_lane(w, dst, sums);
        }
    }
}

}  // namespace detail

/// Adds the values of the warp's active lanes to one record in memory: for each i in [0, N),
/// `dst[i] += sum over the active lanes of values[i]`, atomically and relaxed, component by component.
///
/// ```cpp
/// float g[9] = {...};
/// warpagg::warp_reduce_atomic(w, grad + 9 * id, g, active);  // the default policy
/// warpagg::warp_reduce_atomic(w, grad + 9 * id, g, active, policy{shfl_down});  // the paper
/// ```
///
/// @param w       a model of `warp`; all of its lanes call this together
/// @param dst     `T*`, a span, or an accessor `dst(i) -> T*`; the same record for every lane
/// @param values  N values per lane; those of inactive lanes are ignored, NaN or not
/// @param active  whether this lane has something to add
/// @param Policy  see policy.hpp
///
/// The order in which warps add is not fixed; inside a warp the tree is, and it is the same for every
/// reduction but `per_lane`. Error of the default: (n/32 + 5) u k for n updates of condition k, u = 2^-24 for
/// float. Cost by default, on 32 lanes: one vote, N - 1 + log2(32/N) shuffles, one atomic instruction per 32
/// components.
WARPAGG_EXEC_CHECK_DISABLE
template <class T, int N, warp W, class Dst, class Policy = default_policy<T, N>>
WARPAGG_HD void warp_reduce_atomic(const W& w, Dst dst, const value_t<W, T> (&values)[N],
                                   const mask_t<W>& active, Policy = {}) {
    using idle_rule = typename Policy::idle;
    constexpr bool lanes_alone = std::is_same_v<typename Policy::reduce, reduce::per_lane>;
    constexpr unsigned least = detail::least_lanes<typename Policy::gate>;
    const auto record = commit::destination(dst);

    if constexpr (requires { w.observe(active); }) w.observe(active);
    if constexpr (lanes_alone) {
        commit::each_lane(w, record, values, active);
    } else {
        if constexpr (least > 0) {
            if (detail::popcount(w.ballot(active)) < least) {
                commit::each_lane(w, record, values, active);
                return;
            }
        } else if constexpr (std::is_same_v<idle_rule, idle::skip>) {
            if (skip_if_warp_idle(w, active)) return;
        }
        detail::reduce_and_commit<Policy>(w, record, values, active);
    }
}

/// The same with T and N deduced from `values`.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Dst, class V, int N, class... Policy>
WARPAGG_HD void warp_reduce_atomic(const W& w, Dst dst, const V (&values)[N], const mask_t<W>& active,
                                   Policy... policy) {
    static_assert(sizeof...(Policy) <= 1,
                  "warp_reduce_atomic takes one policy: put the tags into policy{...}");
    warp_reduce_atomic<typename detail::scalar_of<V>::type, N>(w, dst, values, active, policy...);
}

}  // namespace warpagg
