// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// For lanes with different destinations: `warp_match_reduce_atomic`, for histograms, graph
/// scatter, particle deposit.

#include "reduce_atomic.hpp"

namespace warpagg {
namespace detail {

/// Component i of the record of each key, as an accessor by key.
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

/// The components of one key's record, as an accessor by component.
template <class Base>
struct component_of_key {
    Base base;
    unsigned key;
    WARPAGG_HD auto operator()(unsigned i) const { return base(key, i); }
};

/// Combines the values of lanes with equal keys, in a tree over the lanes of each key in their
/// order; the first of them ends with the result. `peers` are the active lanes with this lane's
/// key, none for an inactive lane. Cost: for the largest group of g lanes, ceil(log2 g) times N
/// shuffles and two votes.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class V, int N>
WARPAGG_HD void combine_peers(const W& w, V (&v)[N], const value_t<W, std::uint32_t>& peers) {
    using math::countr_zero;
    using math::popcount;
    using math::select;
    using bits = value_t<W, std::uint32_t>;
    const bits beyond_me = bits(0xfffffffeu) << w.lane();
    bits next = peers & beyond_me;  // the lanes that still hold a part of the result
    // mutate: match_place_from_one
    bits place = popcount(peers & (beyond_me ^ bits(0xffffffffu))) - bits(1u);
    while (w.any(next != 0u)) {
        const auto has_next = next != 0u;
        const auto from = countr_zero(next);
        WARPAGG_UNROLL
        // mutate: match_combines_without_next
        for (int i = 0; i < N; ++i) v[i] = select(has_next, Op::combine(v[i], w.shfl(v[i], from)), v[i]);
        // mutate: match_keeps_those_who_gave
        next &= bits(w.ballot((place & 1u) == 0u));  // those at odd places have passed theirs on
        place = place >> 1u;
    }
}

/// Whether the keys of the active lanes rise from lane to lane, and so all differ. This costs a
/// fraction of a match. Rising keys are often neighboring addresses, for which a match costs more
/// than plain atomics.
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

/// The commit of the records of keys: that of the policy, or else the largest groups that keep all
/// records aligned.
template <class Resolved, class Policy, int N>
// mutate: match_packs_where_plain_is_asked
using commit_of_keys = std::conditional_t<std::is_same_v<typename Resolved::reduce, reduce::per_lane> ||
                                              !std::is_same_v<typename Policy::commit, unset>,
                                          typename Resolved::commit, commit::packed<N % 4 == 0 ? 4 : 2>>;

/// Every active lane commits its own values to the record of its key.
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

/// The record of a key, the same in all lanes, as a destination.
template <int N, class T>
WARPAGG_HD commit::contiguous_record<T> record_of_key(T* base, unsigned key) {
    return {base + std::size_t{key} * N};
}
template <int N, class Base>
WARPAGG_HD auto record_of_key(Base base, unsigned key) {
    return component_of_key<Base>{base, key};
}

/// The limbs of the accumulators of a base, as a base.
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

/// `warp_match_reduce_atomic` with the accumulator `native`.
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

/// Adds the values of each active lane to the record that its key names, equal keys first among
/// themselves: for each i in [0, N), `base[key * N + i] += values[i]`, atomically and relaxed,
/// component by component.
///
/// @snippet warp_match_reduce_atomic.cpp warp_match_reduce_atomic
///
/// @param w       a model of `warp`; all of its lanes call this together
/// @param base    `T*` to the record of key 0, or an accessor `base(key, i) -> T*`
/// @param key     index of this lane's record, 32 bits; ignored for an inactive lane
/// @param values  N values per lane; those of inactive lanes are ignored, NaN or not
/// @param active  whether this lane has something to add
/// @param how     a policy. `reduce` and `commit` apply where all active lanes have one key; `commit`
///                also selects how the record of each key is committed. `per_lane` combines nothing.
///                The gate sets the number of active lanes from which keys are compared
/// @param at      the place of the call; leave it to its default
///
/// @pre All lanes of the warp call this with the same `base`, which holds N values of T for each key
/// in use.
///
/// Lanes of one key combine in a fixed tree in the order of their lane numbers. Cost if the keys of
/// the active lanes rise from lane to lane: one shuffle, two votes, and one atomic per key and
/// component. Otherwise: one `match` and two votes more, and ceil(log2 g) times N shuffles and two
/// votes for the g lanes of the most frequent key. With one key for all lanes: as
/// `warp_reduce_atomic`. If `base` is a pointer to float that is aligned to 16 bytes for N a
/// multiple of 4, or to 8 bytes for N even, records are committed by `packed`.
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

/// The same for an aggregate, a type of yours, at `base[key]`: see aggregate.hpp. On models whose
/// lane values are scalars, not on `emulator::lanes`.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, aggregate R, class Policy = policy<>>
WARPAGG_HD void warp_match_reduce_atomic(const W& w, R* base, const value_t<W, unsigned>& key, const R& value,
                                         const mask_t<W>& active, Policy how = {},
                                         call_site at = call_site::here("warp_match_reduce_atomic")) {
    const detail::components_of<R> components(value);
    warp_match_reduce_atomic(w, detail::destination_of_components(base), key, components.component, active,
                             how, at);
}

/// Does not compile: a key has 32 bits, and a wider one would lose the others.
template <warp W, class Base, class Key, class V, int N, class... More>
requires(std::is_integral_v<Key> && sizeof(Key) > sizeof(unsigned)) void warp_match_reduce_atomic(
    const W&, Base, const Key&, const V (&)[N], const mask_t<W>&, More...) = delete;

/// Does not compile: several tags go into one policy.
template <warp W, class Base, class V, class Tag, class Next, class... More>
requires(!std::is_same_v<Next, call_site>)
    WARPAGG_HD void warp_match_reduce_atomic(const W&, Base, const value_t<W, unsigned>&, const V&,
                                             const mask_t<W>&, Tag, Next, More...) {
    static_assert(std::is_same_v<Next, call_site>,
                  "warp_match_reduce_atomic takes one policy: put the tags into policy{...}");
}

}  // namespace warpagg
