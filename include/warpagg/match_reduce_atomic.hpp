// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Aggregated atomics for lanes with different destinations: `warp_match_reduce_atomic`. Use it for
/// histograms, sums over graph edges, or particle deposition.

#include "reduce_atomic.hpp"

namespace warpagg {
namespace detail {

/// An accessor that takes a key and returns the address of component i of the key's record.
template <class Base, int N>
struct component_by_key {
    Base base;
    unsigned i;
    WARPAGG_HD auto operator()(unsigned key) const {
        if constexpr (requires { base(key, i); }) {
            return base(key, i);
        } else {
            return base + (std::size_t{key} * N + i);  // mutate: match_key_stride_lost
        }
    }
};

/// An accessor that takes i and returns the address of component i of one key's record.
template <class Base>
struct component_of_key {
    Base base;
    unsigned key;
    WARPAGG_HD auto operator()(unsigned i) const { return base(key, i); }
};

/// Combines the values of lanes with equal keys, in a tree over the lanes of each key in the order of
/// their numbers. The first lane of each key receives the result. `peers` has the bits of the active
/// lanes with this lane's key, and is 0 for an inactive lane. Cost: ceil(log2 g) rounds of N shuffles
/// and two votes, where g is the size of the largest group, and one vote more.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class V, int N>
WARPAGG_HD void combine_peers(const W& w, V (&v)[N], const value_t<W, std::uint32_t>& peers) {
    using math::countr_zero;
    using math::popcount;
    using math::select;
    using bits = value_t<W, std::uint32_t>;
    const bits beyond_me = bits(0xfffffffeu) << w.lane();
    bits next = peers & beyond_me;  // the later lanes of the key that still hold a partial result
    // mutate: match_place_from_one
    bits place = popcount(peers & (beyond_me ^ bits(0xffffffffu))) - bits(1u);
    while (w.any(next != 0u)) {
        const auto has_next = next != 0u;
        const auto from = countr_zero(next);
        WARPAGG_UNROLL
        // mutate: match_combines_without_next
        for (int i = 0; i < N; ++i) v[i] = select(has_next, Op::combine(v[i], w.shfl(v[i], from)), v[i]);
        // mutate: match_keeps_those_who_gave
        next &= bits(w.ballot((place & 1u) == 0u));  // lanes at odd places have passed their values on
        place = place >> 1u;
    }
}

/// Returns whether the keys of the active lanes rise from lane to lane, so that all keys differ.
/// `everyone` has the bits of the active lanes. Cost: one shuffle and one vote, less than a match.
/// Rising keys are often neighboring addresses, for which plain atomics are faster than a match.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD bool keys_rise(const W& w, const value_t<W, unsigned>& key, const mask_t<W>& active,
                          std::uint32_t everyone) {
    using math::countr_zero;
    using bits = value_t<W, std::uint32_t>;
    // mutate: match_rises_to_inactive_lanes
    const bits after_me = (bits(0xfffffffeu) << w.lane()) & everyone;
    const auto next = w.shfl(key, countr_zero(after_me));
    return !w.any(active && after_me != 0u && key >= next);  // mutate: match_equal_keys_rise
}

/// The commit of the records of keys. It is the policy's commit, if the policy names one or does not
/// reduce. Otherwise it is `packed` with the largest groups that keep all records aligned.
template <class Resolved, class Policy, int N>
// mutate: match_packs_where_plain_is_asked
using commit_of_keys = std::conditional_t<std::is_same_v<typename Resolved::reduce, reduce::per_lane> ||
                                              !std::is_same_v<typename Policy::commit, unset>,
                                          typename Resolved::commit, commit::packed<N % 4 == 0 ? 4 : 2>>;

/// Commits the values of each active lane to the record of its key. Cost: N atomic instructions, or
/// N / K where `packed<K>` applies.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class Commit, warp W, class Base, class V, int N>
WARPAGG_HD void commit_by_key(const W& w, Base base, const value_t<W, unsigned>& key, const V (&v)[N],
                              const mask_t<W>& active) {
    using record = commit::contiguous_record<V>;
    if constexpr (std::is_same_v<Base, V*> && commit::detail::packs<Op, Commit, W, record, V>) {
        if constexpr (N % Commit::neighbors == 0) {
            if (commit::is_packed<Op, Commit, V>(w, record{base})) {
                // mutate: match_packed_key_stride_lost
                commit::detail::by_groups<Commit::neighbors, 0>(w, base + std::size_t{key} * N, v, active);
                return;
            }
        }
    }
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i)
        w.atomic(Op{}, component_by_key<Base, N>{base, static_cast<unsigned>(i)}, key, v[i], active);
}

/// Returns the record of a uniform key as a destination.
template <int N, class T>
WARPAGG_HD commit::contiguous_record<T> record_of_key(T* base, unsigned key) {
    return {base + std::size_t{key} * N};
}
template <int N, class Base>
WARPAGG_HD auto record_of_key(Base base, unsigned key) {
    return component_of_key<Base>{base, key};
}

/// Returns a base of accumulators as a base of their limbs.
/// @{
template <class Base, int Limbs>
struct limbs_by_key {
    Base base;
    WARPAGG_HD auto operator()(unsigned key, unsigned i) const {
        return base(key, i / Limbs)->limb + i % Limbs;
    }
};
template <class Accumulate>
WARPAGG_HD auto base_of_limbs(accumulator<Accumulate>* base) {
    return base->limb;
}
template <class Accumulate, class Base>
WARPAGG_HD auto base_of_limbs(Base base) {
    constexpr bool are_accumulators = requires {
        { base(0u, 0u) } -> std::same_as<accumulator<Accumulate>*>;
    };
    static_assert(are_accumulators,
                  "a sum that is not native needs a base of accumulator<...>, of the policy's tag");
    return limbs_by_key<Base, Accumulate::limbs>{base};
}
/// @}

/// Implements `warp_match_reduce_atomic` for the accumulator `native`.
WARPAGG_EXEC_CHECK_DISABLE
template <class Policy, warp W, class Base, class V, int N>
WARPAGG_HD void match_and_commit(const W& w, Base base, const value_t<W, unsigned>& key, const V (&values)[N],
                                 const mask_t<W>& active, call_site at) {
    using math::countr_zero;
    using math::popcount;
    using math::select;
    using math::uniform;
    using chosen = resolved_policy<scalar_t<V>, N, Policy>;
    using operation = typename chosen::operation;
    using bits = value_t<W, std::uint32_t>;
    static_assert(
        requires { *(base + 0); } || requires { *base(0u, 0u); },
        "the base is a pointer to the record of key 0, or an accessor base(key, i) -> T*");
    static_assert(!std::is_same_v<typename chosen::commit, commit::staged>,
                  "warp_match_reduce_atomic takes the stage's copy as its base: staged says nothing here");
    static_assert(
        !std::is_same_v<typename chosen::idle, idle::add_zeros>,
        "an idle warp has no keys, so warp_match_reduce_atomic has nowhere to add zeros: take skip");

    const library_call<W> call(w, at);
    if constexpr (requires { w.observe(active); }) w.observe(active);
    if constexpr (requires { w.require_uniform(base); }) w.require_uniform(base);
    if constexpr (std::is_same_v<typename chosen::idle, idle::assume_busy>) {
        if constexpr (requires { w.require_busy(active); }) w.require_busy(active);
    }
    const mask_t<W> adds = opaque(w, active);
    mask_t<W> commits = adds;
    V results[N];
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) results[i] = values[i];

    if constexpr (!std::is_same_v<typename chosen::reduce, reduce::per_lane>) {
        const std::uint32_t everyone = w.ballot(adds);
        if (everyone == 0) return;
        bool dense = true;
        // mutate: match_gate_more_than
        if constexpr (is_gated<typename chosen::gate>) dense = popcount(everyone) >= chosen::gate::lanes;
        if (dense) {
            if (!keys_rise(w, key, adds, everyone)) {
                // mutate: match_without_active_mask
                const bits peers = select(adds, w.match(key) & everyone, bits(0u));
                if (!w.any(adds && peers != everyone)) {
                    // mutate: match_key_of_lane_0
                    const unsigned only = uniform(w.shfl(key, countr_zero(everyone)));
                    reduce_and_commit<chosen>(w, record_of_key<N>(base, only), values, adds);
                    return;
                }
                combine_peers<operation>(w, results, peers);
                commits = adds && countr_zero(peers) == w.lane();  // mutate: match_idle_lane_commits
            }
        }
    }
    using commit_rule = commit_of_keys<chosen, Policy, N>;
    commit_by_key<operation, commit_rule>(w, base, key, results, commits);
}

}  // namespace detail

/// Adds the values of each active lane to the record of its key: for each i in [0, N),
/// `base[key * N + i] += values[i]`, atomically and relaxed, component by component. Lanes with
/// equal keys reduce first, unless the policy's gate or `per_lane` prevents it.
///
/// @snippet warp_match_reduce_atomic.cpp warp_match_reduce_atomic
///
/// @param w       a model of `warp`
/// @param base    `T*` to the record of key 0, or an accessor `base(key, i) -> T*`. With an
///                accumulator, `accumulator<...>` takes the place of T
/// @param key     index of this lane's record, 32 bits; ignored for an inactive lane
/// @param values  N values per lane; values of inactive lanes are ignored, even if they are NaN
/// @param active  whether this lane has values to add
/// @param how     a policy. Its reduce tag applies if all active lanes have one key; `per_lane`
///                combines nothing. Its commit tag also applies to the record of each key. Its gate
///                sets the number of active lanes from which keys are compared
/// @param at      the call site; leave it at its default
///
/// @pre All lanes of the warp call this together, with the same `base`, which holds N values of T for
/// each key in use.
///
/// Order: lanes of one key combine in a fixed tree, in the order of their numbers.
///
/// Cost if the keys of the active lanes rise from lane to lane: one shuffle, two votes, and one
/// atomic per key and component. Otherwise it also takes one `match`, two votes, and ceil(log2 g)
/// rounds of N shuffles and two votes, where g lanes have the most frequent key. If all active lanes
/// have one key, `warp_reduce_atomic`'s reduction and commit take the place of these rounds. Records
/// are committed by `packed` if `base` is a pointer to float that is aligned to 16 bytes (N a multiple
/// of 4) or to 8 bytes (other even N).
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Base, class V, int N, class Policy = policy<>>
WARPAGG_HD void warp_match_reduce_atomic(const W& w, Base base, const value_t<W, unsigned>& key,
                                         const V (&values)[N], const mask_t<W>& active, Policy how = {},
                                         call_site at = call_site::here("warp_match_reduce_atomic")) {
    static_assert(detail::is_policy<Policy>,
                  "warp_match_reduce_atomic takes one policy: put the tags into policy{...}");
    using accumulation = typename Policy::accumulate;
    static_assert(!detail::is_between_warps<accumulation>,
                  "between_warps goes with warp_reduce_atomic: here take what it is of");
    if constexpr (detail::is_accumulated<accumulation>) {
        static_assert(std::is_same_v<scalar_t<V>, float>,
                      "accumulators other than native take values of float");
        value_t<W, typename accumulation::limb> limbs[N * accumulation::limbs];
        {
            const detail::library_call<W> call(w, at);
            detail::decompose(w, how.accumulating(), values, active, limbs);
        }
        warp_match_reduce_atomic(w, detail::base_of_limbs<accumulation>(base), key, limbs, active,
                                 typename detail::policy_of_limbs<Policy>::type{}, at);
    } else {
        detail::match_and_commit<Policy>(w, base, key, values, active, at);
    }
}

/// Works as above for an aggregate, a user's type, at `base[key]`: see aggregate.hpp. Requires a model
/// whose value type is a scalar, so it does not compile on `emulator::lanes`.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, aggregate R, class Policy = policy<>>
WARPAGG_HD void warp_match_reduce_atomic(const W& w, R* base, const value_t<W, unsigned>& key, const R& value,
                                         const mask_t<W>& active, Policy how = {},
                                         call_site at = call_site::here("warp_match_reduce_atomic")) {
    const detail::components_of<R> components(value);
    warp_match_reduce_atomic(w, detail::destination_of_components(base), key, components.component, active,
                             how, at);
}

/// Does not compile: a key has 32 bits, and a wider key would lose its upper bits.
template <warp W, class Base, class Key, class V, int N, class... More>
requires(std::is_integral_v<Key> && sizeof(Key) > sizeof(unsigned)) void warp_match_reduce_atomic(
    const W&, Base, const Key&, const V (&)[N], const mask_t<W>&, More...) = delete;

/// Does not compile: put several tags into one policy.
template <warp W, class Base, class V, class Tag, class Next, class... More>
requires(!std::is_same_v<Next, call_site>)
    WARPAGG_HD void warp_match_reduce_atomic(const W&, Base, const value_t<W, unsigned>&, const V&,
                                             const mask_t<W>&, Tag, Next, More...) {
    static_assert(std::is_same_v<Next, call_site>,
                  "warp_match_reduce_atomic takes one policy: put the tags into policy{...}");
}

}  // namespace warpagg
