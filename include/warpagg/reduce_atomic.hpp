// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Aggregated atomics for lanes with one destination: `warp_reduce_atomic` and `skip_if_warp_idle`.

#include "aggregate.hpp"
#include "core/call_site.hpp"
#include "default_policy.hpp"
#include "detail/accumulate/decompose.hpp"
#include "detail/commit/commit.hpp"
#include "detail/mistakes.hpp"
#include "detail/reduce/scatter.hpp"
#include "detail/reduce/tree.hpp"
#include "fields.hpp"
#include "policy.hpp"
#include "stage.hpp"
#include "warp/concept.hpp"

namespace warpagg {

/// Returns whether the warp is idle: no lane is active. The result is uniform, so the whole warp can
/// `continue` together. All lanes of the warp call this. Cost: one vote, no memory access. Source:
/// the paper, Figure 8, lines 18 to 22.
///
/// @snippet warp_reduce_atomic.cpp skip_if_warp_idle
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD bool skip_if_warp_idle(const W& w, const mask_t<W>& active,
                                  call_site at = call_site::here("skip_if_warp_idle")) {
    const detail::library_call<W> call(w, at);
    return !w.any(active);  // mutate: idle_rule_inverted
}

/// Does not compile. The message explains the mistake in the call.
template <class... Args>
requires(!detail::skip_call<Args...>) WARPAGG_HD bool skip_if_warp_idle(const Args&...) {
    detail::explain<detail::mistake_in_skip<Args...>()>();
    return false;
}

namespace detail {

/// Returns the flag, but hides its value from the compiler, which otherwise may split a loop on it.
WARPAGG_EXEC_CHECK_DISABLE
template <class W>
WARPAGG_HD mask_t<W> opaque(const W& w, const mask_t<W>& flag) {
    if constexpr (requires { w.opaque(flag); }) {
        return w.opaque(flag);  // mutate: flag_not_opaque
    } else {
        return flag;
    }
}

/// Returns the values of active lanes. For inactive lanes it returns the identity of the operation,
/// even if their values are NaN.
template <class Op, class V, class Mask>
struct active_values {
    const V* values;
    const Mask& active;

    WARPAGG_HD V operator()(int i) const {
        using math::select;  // argument-dependent lookup finds the overload for SIMD values
        // mutate: active_mask_dropped
        return select(active, values[i], V(Op::template identity<scalar_t<V>>()));
    }
};

WARPAGG_EXEC_CHECK_DISABLE
template <class Resolved, warp W, class Record, class V, int N>
WARPAGG_HD void reduce_and_commit(const W& w, Record record, const V (&values)[N], const mask_t<W>& active) {
    using op = typename Resolved::operation;
    using reduction = typename Resolved::reduce;
    V results[N];
    reduce_over_warp<op>(reduction{}, w, active_values<op, V, mask_t<W>>{values, active}, results);
    commit::results<op, reduction, typename Resolved::commit>(w, record, results);
}

/// Commits each active lane's own values if too few lanes are active to reduce. Returns whether it has.
WARPAGG_EXEC_CHECK_DISABLE
template <class Resolved, warp W, class Record, class V, int N>
WARPAGG_HD bool commit_ungated(const W& w, Record record, const V (&values)[N], const mask_t<W>& active) {
    using op = typename Resolved::operation;
    using gate = typename Resolved::gate;
    using ungated = typename Resolved::ungated_commit;
    constexpr bool may_pack = commit::detail::packs<op, ungated, W, Record, V>;
    constexpr unsigned most =
        may_pack && gate::lanes_if_packed > gate::lanes ? gate::lanes_if_packed : gate::lanes;
    if constexpr (most > 1) {
        const unsigned lanes = math::popcount(w.ballot(active));
        if (lanes < most) [[unlikely]] {
            const unsigned least =
                // mutate: gate_thresholds_swapped
                commit::is_packed<op, ungated, V>(w, record) ? gate::lanes_if_packed : gate::lanes;
            if (lanes < least) {  // mutate: gate_at_most
                V own[N];  // a copy, because indexing by lanes would move `values` from registers to memory
                WARPAGG_UNROLL
                for (int i = 0; i < N; ++i) own[i] = values[i];
                commit::each_lane<op, ungated>(w, record, own, active);
                return true;
            }
        }
    }
    return false;
}

/// Implements `warp_reduce_atomic` for an accessor and a resolved policy.
WARPAGG_EXEC_CHECK_DISABLE
template <class Resolved, warp W, class Record, class V, int N>
WARPAGG_HD void apply_policy(const W& w, Record record, const V (&values)[N], const mask_t<W>& active) {
    using op = typename Resolved::operation;
    if constexpr (requires { w.observe(active); }) w.observe(active);  // mutate: calls_not_observed
    // mutate: destination_not_checked
    if constexpr (requires { w.require_uniform(record(0u)); }) w.require_uniform(record(0u));
    if constexpr (requires { Record::components; })
        static_assert(Record::components == N, "the fields must have as many components as there are values");
    if constexpr (std::is_same_v<typename Resolved::reduce, reduce::per_lane>) {
        commit::each_lane<op, typename Resolved::commit>(w, record, values, active);
    } else {
        // Most warps of a rasterizer are idle, so this test comes before the gate's.
        if constexpr (std::is_same_v<typename Resolved::idle, idle::skip>) {
            if (!w.any(active)) return;  // mutate: idle_warp_not_skipped
        }
        if constexpr (is_gated<typename Resolved::gate>) {
            if (commit_ungated<Resolved>(w, record, values, active)) return;
        }
        reduce_and_commit<Resolved>(w, record, values, active);
    }
}

}  // namespace detail

/// Adds the values of the warp's active lanes to one record in memory: for each i in [0, N),
/// `dst[i] += sum over the active lanes of values[i]`, atomically and relaxed, component by
/// component.
///
/// @snippet warp_reduce_atomic.cpp warp_reduce_atomic
///
/// The following examples name a policy and another operation than the sum, and add to a structure
/// of arrays:
///
/// @snippet warp_reduce_atomic.cpp policy
/// @snippet warp_reduce_atomic.cpp operation
/// @snippet warp_reduce_atomic.cpp fields
/// @snippet warp_reduce_atomic.cpp accessor
///
/// This example names an accumulator. The sum is rounded once and does not depend on the order of
/// additions:
///
/// @snippet accumulate.cpp exact
///
/// @param w       a model of `warp`
/// @param dst     `T*`, a span, `fields`, an accessor `dst(i) -> T*`, or a record of a `stage`
///                with `policy{staged}`. With an accumulator, `accumulator<...>` takes the place of T
/// @param values  N values per lane; values of inactive lanes are ignored, even if they are NaN
/// @param active  whether this lane has values to add
/// @param how     a policy; defaults fill the axes without a tag: see default_policy.hpp
/// @param at      the call site; leave it at its default
///
/// @pre All lanes of the warp call this together, with the same `dst`, which holds N values of T,
/// aligned as T.
///
/// @note Accumulators other than `native` decompose values even in idle warps; call
/// `skip_if_warp_idle` first if many warps are idle. `fixed` with a `fault` takes one more vote.
///
/// Order: warps commit in an unspecified order. Within a warp, `shfl_down`, `butterfly` and `scatter`
/// add in the same tree: first lanes W/2 apart, then W/4 apart, and so on to neighbors. Lanes that do
/// not reduce, because of `per_lane` or the gate, commit in an unspecified order.
///
/// Error of a float sum of n values with condition number k: on W lanes at most
/// (n/W + log2 W) u k if all lanes are active, u = 2^-24, and n u k otherwise.
///
/// Cost by default on 32 lanes: one vote (two with a gate), about N - 1 + log2(32/N) shuffles (N `redux`
/// instructions for 32-bit integers and N up to 32), and one atomic instruction per 32 components.
WARPAGG_EXEC_CHECK_DISABLE
template <class T, int N, warp W, class Dst, class Policy = policy<>>
WARPAGG_HD void warp_reduce_atomic(const W& w, Dst dst, const value_t<W, T> (&values)[N],
                                   const mask_t<W>& active, Policy how = {},
                                   call_site at = call_site::here("warp_reduce_atomic")) {
    static_assert(detail::is_policy<Policy>,
                  "warp_reduce_atomic takes one policy: put the tags into policy{...}");
    using accumulation = typename Policy::accumulate;
    using resolved_policy = detail::resolved_policy<T, N, Policy>;
    static_assert(!detail::is_accumulated<accumulation> || std::is_same_v<T, float>,
                  "accumulators other than native take values of float");
    if constexpr (detail::is_accumulated<accumulation> && !detail::is_between_warps<accumulation>) {
        using limb = typename accumulation::limb;
        value_t<W, limb> limbs[N * accumulation::limbs];
        {
            const detail::library_call<W> call(w, at);
            detail::decompose(w, how.accumulating(), values, active, limbs);
        }
        warp_reduce_atomic<limb, N * accumulation::limbs>(
            w, detail::record_of_limbs<accumulation>(dst), limbs, active,
            typename detail::policy_of_limbs<Policy>::type{}, at);
    } else {
        const detail::library_call<W> call(w, at);
        if constexpr (std::is_same_v<typename resolved_policy::idle, idle::assume_busy>) {
            // mutate: busy_not_checked
            if constexpr (requires { w.require_busy(active); }) w.require_busy(active);
        }
        const auto record = [&] {
            if constexpr (detail::is_between_warps<accumulation>) {
                return detail::results_to_accumulators<typename accumulation::storage>(how.accumulating(),
                                                                                       dst);
            } else {
                return commit::record_of<typename resolved_policy::commit>(dst);
            }
        }();
        detail::apply_policy<resolved_policy>(w, record, values, detail::opaque(w, active));
    }
}

/// Works as above, with T and N deduced from `values`.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Dst, class V, int N, class Policy = policy<>>
WARPAGG_HD void warp_reduce_atomic(const W& w, Dst dst, const V (&values)[N], const mask_t<W>& active,
                                   Policy how = {},
                                   call_site at = call_site::here("warp_reduce_atomic")) requires
    detail::reduce_call<W, Dst, V[N], mask_t<W>, Policy> {
    warp_reduce_atomic<scalar_t<V>, N>(w, dst, values, active, how, at);
}

/// Works as above for an aggregate, a user's type: see aggregate.hpp. Requires a model whose value
/// type is a scalar, so it does not compile on `emulator::lanes`.
///
/// @snippet warp_reduce_atomic.cpp a type of yours
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Dst, aggregate R, class Policy = policy<>>
WARPAGG_HD void warp_reduce_atomic(const W& w, Dst dst, const R& value, const mask_t<W>& active,
                                   Policy how = {},
                                   call_site at = call_site::here("warp_reduce_atomic")) requires
    detail::reduce_call<W, Dst, R, mask_t<W>, Policy> {
    const detail::components_of<R> components(value);
    warp_reduce_atomic(w, detail::destination_of_components(dst), components.component, active, how, at);
}

/// Does not compile. The message explains the mistake in the call.
template <class... Args>
requires(!detail::reduce_call<Args...>) WARPAGG_HD void warp_reduce_atomic(const Args&...) {
    detail::explain<detail::mistake_in_reduce<Args...>()>();
}

}  // namespace warpagg
