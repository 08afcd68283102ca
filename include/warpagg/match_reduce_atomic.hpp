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
    template <class Key>
    WARPAGG_HD auto operator()(Key key) const {
        if constexpr (requires { base(key, i); }) {
            return base(key, i);
        } else {
            return base + (std::size_t{key} * N + i);  // mutate: match_key_stride_lost
        }
    }
};

/// An accessor that takes i and returns the address of component i of one key's record.
template <class Base, class Key>
struct component_of_key {
    Base base;
    Key key;
    WARPAGG_HD auto operator()(unsigned i) const { return base(key, i); }
};

/// Returns the bits of the lanes after this one.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W>
WARPAGG_HD value_t<W, lane_bits_t<W>> lanes_after(const W& w) {
    using math::convert;
    using bits = lane_bits_t<W>;
    return value_t<W, bits>(~bits{1}) << convert<bits>(w.lane());
}

/// Combines the values of lanes with equal keys, in a tree over the lanes of each key in the order of
/// their numbers. The first lane of each key receives the result. `peers` has the bits of the active
/// lanes with this lane's key, and is 0 for an inactive lane. Cost: ceil(log2 g) rounds of N shuffles
/// and two votes, where g is the size of the largest group, and one vote more.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class V, int N>
WARPAGG_HD void combine_peers(const W& w, V (&v)[N], const value_t<W, lane_bits_t<W>>& peers) {
    using math::countr_zero;
    using math::popcount;
    using math::select;
    using bits = value_t<W, lane_bits_t<W>>;
    const bits beyond_me = lanes_after(w);
    bits next = peers & beyond_me;  // the later lanes of the key that still hold a partial result
    // mutate: match_place_from_one
    auto place = popcount(peers & (beyond_me ^ bits(~lane_bits_t<W>{0}))) - value_t<W, unsigned>(1u);
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
template <warp W, class Key>
WARPAGG_HD bool keys_rise(const W& w, const Key& key, const mask_t<W>& active, lane_bits_t<W> everyone) {
    using math::countr_zero;
    // mutate: match_rises_to_inactive_lanes
    const auto after_me = lanes_after(w) & everyone;
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
template <class Op, class Commit, warp W, class Base, class Key, class V, int N>
WARPAGG_HD void commit_by_key(const W& w, Base base, const Key& key, const V (&v)[N],
                              const mask_t<W>& active) {
    using record = commit::contiguous_record<V>;
    if constexpr (std::is_same_v<Base, V*> && commit::detail::packs<Op, Commit, W, record, V>) {
        if constexpr (N % Commit::neighbors == 0) {
            if (commit::is_packed<Op, Commit, V>(w, record{base})) {
                // mutate: match_packed_key_stride_lost
                commit::detail::by_groups<Op, Commit::neighbors, 0>(w, base + std::size_t{key} * N, v,
                                                                    active);
                return;
            }
        }
    }
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i)
        w.atomic(Op{}, component_by_key<Base, N>{base, static_cast<unsigned>(i)}, key, v[i], active);
}

/// Returns the record of a uniform key as a destination.
template <int N, class T, class Key>
WARPAGG_HD commit::contiguous_record<T> record_of_key(T* base, Key key) {
    return {base + std::size_t{key} * N};
}
template <int N, class Base, class Key>
WARPAGG_HD auto record_of_key(Base base, Key key) {
    return component_of_key<Base, Key>{base, key};
}

/// Returns a base of accumulators as a base of their limbs.
/// @{
template <class Base, int Limbs>
struct limbs_by_key {
    Base base;
    template <class Key>
    WARPAGG_HD auto operator()(Key key, unsigned i) const {
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

/// Returns a key as an unsigned lane value of 32 bits, or of 64 bits if the key has 64 bits.
template <class W, class Key>
WARPAGG_HD auto unsigned_key(const Key& key) {
    using scalar = scalar_t<Key>;
    using wide = std::conditional_t<sizeof(scalar) == 8, std::uint64_t, std::uint32_t>;
    if constexpr (std::is_same_v<Key, scalar>) {
        return value_t<W, wide>(static_cast<wide>(key));
    } else {
        using math::convert;
        return convert<wide>(key);
    }
}

/// How the keys of the active lanes relate.
enum class key_relation {
    none,       ///< no lane is active
    different,  ///< lanes commit on their own: all keys differ, or few lanes are active
    same,       ///< all active lanes have one key
    mixed,      ///< some lanes have equal keys
};

/// The active lanes of a warp by key.
template <warp W, class Key>
struct lanes_by_key {
    Key key;
    mask_t<W> active;
    lane_bits_t<W> everyone;           ///< the bits of the active lanes; 0 if they were not compared
    value_t<W, lane_bits_t<W>> peers;  ///< the bits of the active lanes with the lane's key, if mixed
    key_relation relation;
};

/// Compares the keys of the active lanes if there are at least `least` of them.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Key>
WARPAGG_HD lanes_by_key<W, Key> compare_keys(const W& w, const Key& key, const mask_t<W>& active,
                                             unsigned least) {
    using math::popcount;
    using math::select;
    using bits = value_t<W, lane_bits_t<W>>;
    lanes_by_key<W, Key> lanes{key, active, w.ballot(active), bits(0u), key_relation::none};
    if (lanes.everyone == 0) return lanes;
    lanes.relation = key_relation::different;
    // mutate: match_gate_more_than
    if (popcount(lanes.everyone) < least) return lanes;
    if (keys_rise(w, key, active, lanes.everyone)) return lanes;
    // mutate: match_without_active_mask
    lanes.peers = select(active, w.match(key) & lanes.everyone, bits(0u));
    lanes.relation =
        w.any(active && lanes.peers != lanes.everyone) ? key_relation::mixed : key_relation::same;
    return lanes;
}

/// Combines the values of lanes with equal keys and commits the results.
WARPAGG_EXEC_CHECK_DISABLE
template <class Policy, warp W, class Key, class Base, class V, int N>
WARPAGG_HD void commit_by_relation(const W& w, const lanes_by_key<W, Key>& lanes, Base base,
                                   const V (&values)[N]) {
    using math::countr_zero;
    using math::uniform;
    using chosen = resolved_policy<scalar_t<V>, N, Policy>;
    using operation = typename chosen::operation;
    using commit_rule = commit_of_keys<chosen, Policy, N>;
    if (lanes.relation == key_relation::none) return;
    if (lanes.relation == key_relation::same) {
        // mutate: match_key_of_lane_0
        const auto only = uniform(w.shfl(lanes.key, countr_zero(lanes.everyone)));
        reduce_and_commit<chosen>(w, record_of_key<N>(base, only), values, lanes.active);
        return;
    }
    V results[N];
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) results[i] = values[i];
    mask_t<W> commits = lanes.active;
    if (lanes.relation == key_relation::mixed) {
        combine_peers<operation>(w, results, lanes.peers);
        commits = lanes.active && countr_zero(lanes.peers) == w.lane();  // mutate: match_idle_lane_commits
    }
    commit_by_key<operation, commit_rule>(w, base, lanes.key, results, commits);
}

/// Checks the arguments of `warp_match_reduce_atomic` and `matched_lanes::add`.
WARPAGG_EXEC_CHECK_DISABLE
template <class Chosen, warp W, class Base>
WARPAGG_HD void check_base(const W& w, Base base) {
    static_assert(!std::is_same_v<typename Chosen::commit, commit::staged>,
                  "warp_match_reduce_atomic takes the stage's copy as its base: staged says nothing here");
    static_assert(
        !std::is_same_v<typename Chosen::idle, idle::add_zeros>,
        "an idle warp has no keys, so warp_match_reduce_atomic has nowhere to add zeros: take skip");
    if constexpr (requires { w.require_uniform(base); }) w.require_uniform(base);
}

/// Implements `warp_match_reduce_atomic` for the accumulator `native`.
WARPAGG_EXEC_CHECK_DISABLE
template <class Policy, warp W, class Base, class Key, class V, int N>
WARPAGG_HD void match_and_commit(const W& w, Base base, const Key& key, const V (&values)[N],
                                 const mask_t<W>& active, call_site at) {
    using chosen = resolved_policy<scalar_t<V>, N, Policy>;
    const library_call<W> call(w, at);
    if constexpr (requires { w.observe(active); }) w.observe(active);
    check_base<chosen>(w, base);
    if constexpr (std::is_same_v<typename chosen::idle, idle::assume_busy>) {
        if constexpr (requires { w.require_busy(active); }) w.require_busy(active);
    }
    const mask_t<W> adds = opaque(w, active);
    if constexpr (std::is_same_v<typename chosen::reduce, reduce::per_lane>) {
        commit_by_key<typename chosen::operation, commit_of_keys<chosen, Policy, N>>(w, base, key, values,
                                                                                     adds);
    } else {
        commit_by_relation<Policy>(w, compare_keys(w, key, adds, chosen::gate::lanes), base, values);
    }
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
/// @param key     index of this lane's record, an integer of up to 64 bits; ignored for an inactive
///                lane
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
template <warp W, class Base, class Key, class V, int N, class Policy = policy<>>
WARPAGG_HD void warp_match_reduce_atomic(const W& w, Base base, const Key& key, const V (&values)[N],
                                         const mask_t<W>& active, Policy how = {},
                                         call_site at = call_site::here("warp_match_reduce_atomic")) requires
    detail::match_reduce_call<W, Base, Key, V[N], mask_t<W>, Policy> {
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
        detail::match_and_commit<Policy>(w, base, detail::unsigned_key<W>(key), values, active, at);
    }
}

/// Works as above for an aggregate, a user's type, at `base[key]`: see aggregate.hpp. Requires a model
/// whose value type is a scalar, so it does not compile on `emulator::lanes`.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, aggregate R, class Key, class Policy = policy<>>
WARPAGG_HD void warp_match_reduce_atomic(const W& w, R* base, const Key& key, const R& value,
                                         const mask_t<W>& active, Policy how = {},
                                         call_site at = call_site::here("warp_match_reduce_atomic")) requires
    detail::match_reduce_call<W, R*, Key, R, mask_t<W>, Policy> {
    const detail::components_of<R> components(value);
    warp_match_reduce_atomic(w, detail::destination_of_components(base), key, components.component, active,
                             how, at);
}

/// Does not compile. The message explains the mistake in the call.
template <class... Args>
requires(!detail::match_reduce_call<Args...>) WARPAGG_HD void warp_match_reduce_atomic(const Args&...) {
    detail::explain<detail::mistake_in_match_reduce<Args...>()>();
}

/// The lanes of a warp, grouped by key. `match` returns it. It refers to the warp, which must outlive
/// it.
template <warp W, class Key>
class matched_lanes {
  public:
    /// `match` calls this.
    WARPAGG_HD matched_lanes(const W& w, const detail::lanes_by_key<W, Key>& lanes) : w_(w), lanes_(lanes) {}

    /// Adds the values of each active lane to the record of its key, as `warp_match_reduce_atomic`
    /// does with the key and the active lanes that `match` has compared. All lanes of the warp call
    /// this together. The gate of the policy has no effect. Cost: that of `warp_match_reduce_atomic`
    /// without its comparison of keys.
    ///
    /// @param base    `T*` to the record of key 0, or an accessor `base(key, i) -> T*`; the same in all
    ///                lanes
    /// @param values  N values per lane; values of inactive lanes are ignored, even if they are NaN
    /// @param how     a policy with the accumulator `native`
    /// @param at      the call site; leave it at its default
    WARPAGG_EXEC_CHECK_DISABLE
    template <class Base, class V, int N, class Policy = policy<>>
    WARPAGG_HD void add(
        Base base, const V (&values)[N], [[maybe_unused]] Policy how = {},
        call_site at = call_site::here("add")) const requires detail::add_call<Base, V[N], Policy> {
        static_assert(!detail::is_accumulated<typename Policy::accumulate>,
                      "add takes the accumulator native: for others, call warp_match_reduce_atomic");
        using chosen = detail::resolved_policy<scalar_t<V>, N, Policy>;
        const detail::library_call<W> call(w_, at);
        detail::check_base<chosen>(w_, base);
        if constexpr (std::is_same_v<typename chosen::reduce, reduce::per_lane>) {
            detail::commit_by_key<typename chosen::operation, detail::commit_of_keys<chosen, Policy, N>>(
                w_, base, lanes_.key, values, lanes_.active);
        } else {
            detail::commit_by_relation<Policy>(w_, lanes_, base, values);
        }
    }

    /// Does not compile. The message explains the mistake in the call.
    template <class... Args>
    requires(!detail::add_call<Args...>) WARPAGG_HD void add(const Args&...) const {
        detail::explain<detail::mistake_in_add<Args...>()>();
    }

  private:
    const W& w_;
    detail::lanes_by_key<W, Key> lanes_;
};

/// Groups the active lanes by key, so that several calls of `add` compare the keys only once. Use it in
/// loops over the attributes of a record.
///
/// @snippet warp_match_reduce_atomic.cpp match
///
/// @param w       a model of `warp`
/// @param key     index of this lane's record, an integer of up to 64 bits; ignored for an inactive
///                lane
/// @param active  whether this lane has values to add
/// @param at      the call site; leave it at its default
///
/// @pre All lanes of the warp call this together.
///
/// Cost: one shuffle and two votes if the keys of the active lanes rise from lane to lane; otherwise
/// also one `match` and one vote.
WARPAGG_EXEC_CHECK_DISABLE
template <warp W, class Key>
WARPAGG_HD auto match(const W& w, const Key& key, const mask_t<W>& active,
                      call_site at = call_site::here("match")) {
    const detail::library_call<W> call(w, at);
    if constexpr (requires { w.observe(active); }) w.observe(active);
    const auto index = detail::unsigned_key<W>(key);
    return matched_lanes(w, detail::compare_keys(w, index, detail::opaque(w, active), 0));
}

/// Does not compile. The message explains the mistake in the call.
template <class... Args>
requires(!detail::match_call<Args...>) WARPAGG_HD detail::not_matched match(const Args&...) {
    detail::explain<detail::mistake_in_match<Args...>()>();
    return {};
}

}  // namespace warpagg
