// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Policies, which select how `warp_reduce_atomic` and `warp_match_reduce_atomic` work. A policy is
/// a set of tags, as in `policy{shfl_down, skip}`. The defaults of the other axes depend on the type
/// and the number of the values: see default_policy.hpp.

#include "accumulator.hpp"
#include "core/axis.hpp"
#include "core/operation.hpp"
#include "core/tags.hpp"

namespace warpagg {

namespace detail {

/// The placeholder of an axis without a tag.
struct unset {};

/// The type of the tag on axis A, or `unset`.
template <axis A, class... Tags>
struct named {
    using type = unset;
};
template <axis A, class Tag, class... Tags>
struct named<A, Tag, Tags...> {
    using type = std::conditional_t<Tag::axis == A, Tag, typename named<A, Tags...>::type>;
};
template <axis A, class... Tags>
using named_t = typename named<A, Tags...>::type;

/// Returns the object of the tag on axis A, or `unset`.
template <axis A>
WARPAGG_HD constexpr unset object_of() {
    return {};
}
template <axis A, class Tag, class... Tags>
WARPAGG_HD constexpr auto object_of(Tag tag, Tags... tags) {
    if constexpr (Tag::axis == A) {
        return tag;
    } else {
        return object_of<A>(tags...);
    }
}

/// Holds the object of a tag. It is empty if the tag is empty.
template <class Tag, bool = __is_empty(Tag)>
class optional_member {
  public:
    optional_member() = default;
    constexpr WARPAGG_HD explicit optional_member(Tag) {}
    constexpr WARPAGG_HD Tag accumulating() const { return {}; }
};
template <class Tag>
class optional_member<Tag, false> {
  public:
    optional_member() = default;
    constexpr WARPAGG_HD explicit optional_member(Tag tag) : tag_(tag) {}
    constexpr WARPAGG_HD Tag accumulating() const { return tag_; }

  private:
    Tag tag_;
};

template <class Tag, class Default>
using or_default = std::conditional_t<std::is_same_v<Tag, unset>, Default, Tag>;

template <class Reduce>
inline constexpr auto placement_of = Reduce::placement;
template <>
inline constexpr auto placement_of<unset> =
    reduce::result_placement::every_lane;  // the default reduction suits any commit

template <class Reduce>
inline constexpr bool leaves_own_values =
    placement_of<Reduce> == reduce::result_placement::own_lane && !std::is_same_v<Reduce, reduce::per_lane>;
template <class Reduce, class Commit>
inline constexpr bool spreads_own_values =
    placement_of<Reduce> == reduce::result_placement::own_lane&& std::is_same_v<Commit, commit::contiguous>;
template <class Reduce, class Commit>
inline constexpr bool spreads_first_lane =
    placement_of<Reduce> == reduce::result_placement::first_lane&& std::is_same_v<Commit, commit::contiguous>;
template <class Commit>
inline constexpr bool by_one_lane = std::is_same_v<Commit, commit::scalar>;
template <unsigned K>
inline constexpr bool by_one_lane<commit::packed<K>> = true;
template <class Reduce, class Commit>
inline constexpr bool gathers_spread =
    placement_of<Reduce> == reduce::result_placement::spread&& by_one_lane<Commit>;
template <class Gate>
inline constexpr bool is_gated = Gate::lanes > 0;
template <>
inline constexpr bool is_gated<unset> = false;

/// Is true for `between_warps`, which accumulates only the warp's result.
template <class Accumulate>
inline constexpr bool is_between_warps = requires {
    typename Accumulate::storage;
};

}  // namespace detail

/// A set of tags, at most one per axis, in any order. Two tags of one axis do not compile, nor do
/// tags that cannot work together; the error message names the reason.
///
/// @snippet warp_reduce_atomic.cpp policy
template <class... Tags>
struct policy : detail::optional_member<detail::named_t<axis::accumulate, Tags...>> {
    /// The number of tags on axis A.
    template <axis A>
    static constexpr int count = (0 + ... + (Tags::axis == A ? 1 : 0));
    static_assert(count<axis::operation> <= 1,
                  "a policy takes one operation: minimum, maximum, bit_and, bit_or or bit_xor");
    static_assert(count<axis::reduce> <= 1,
                  "a policy takes one reduce tag: per_lane, shfl_down, butterfly, scatter or redux");
    static_assert(
        count<axis::accumulate> <= 1,
        "a policy takes one accumulate tag: native, f64, compensated, fixed<Q>, binned<K> or exact");
    static_assert(count<axis::commit> <= 1,
                  "a policy takes one commit tag: scalar, contiguous, packed<K> or staged");
    static_assert(count<axis::idle> <= 1, "a policy takes one idle tag: skip, assume_busy or add_zeros");
    // mutate: two_gates_accepted
    static_assert(count<axis::gate> <= 1, "a policy takes one gate tag: always or at_least<K>");

    static_assert(count<axis::scope> <= 1,
                  "a policy takes one scope: block_scope, device_scope or system_scope");

    /// The type of the tag on this axis, or the placeholder `unset`.
    /// @{
    using operation = detail::named_t<axis::operation, Tags...>;
    using reduce = detail::named_t<axis::reduce, Tags...>;
    using accumulate = detail::named_t<axis::accumulate, Tags...>;
    using commit = detail::named_t<axis::commit, Tags...>;
    using idle = detail::named_t<axis::idle, Tags...>;
    using gate = detail::named_t<axis::gate, Tags...>;
    using scope = detail::named_t<axis::scope, Tags...>;
    /// @}

    static_assert(
        !detail::leaves_own_values<reduce>,
        "own_lane is for per_lane: a reduction leaves its sums in first_lane, every_lane or spread");
    static_assert(!detail::spreads_own_values<reduce, commit>,
                  "per_lane commits each lane's own values: contiguous has no sums to spread over the lanes");
    static_assert(!detail::spreads_first_lane<reduce, commit>,
                  "shfl_down and cub leave the sums in lane 0: contiguous needs butterfly or scatter");
    static_assert(
        !detail::gathers_spread<reduce, commit>,  // mutate: spread_results_to_lane_0
        "scatter leaves the sums spread over the lanes: scalar and packed need shfl_down or butterfly");
    static_assert(!(std::is_same_v<idle, warpagg::idle::add_zeros> &&
                    std::is_same_v<reduce, warpagg::reduce::per_lane>),
                  "per_lane has no sums, so an idle warp has no zeros to add: take skip");
    static_assert(!(std::is_same_v<reduce, warpagg::reduce::per_lane> && detail::is_gated<gate>),
                  "per_lane has no reduction for at_least<K> to stand before: take always");
    static_assert(!std::is_same_v<commit, warpagg::commit::staged> ||
                      std::is_same_v<operation, detail::unset>,
                  "a stage is added to memory: staged goes with the sum");
    static_assert(!(std::is_same_v<idle, warpagg::idle::add_zeros> && detail::is_gated<gate>),
                  "at_least<K> sends an idle warp to per-lane atomics, so it never adds zeros: take skip");

    static_assert(
        !detail::is_accumulated<accumulate> || count<axis::operation> == 0,
        "f64, compensated, fixed<Q>, binned<K> and exact are ways of keeping a sum: name no operation");
    static_assert(!detail::is_accumulated<accumulate> || !std::is_same_v<commit, warpagg::commit::staged>,
                  "a stage is added to memory as it is: staged goes with native");

    /// Creates a policy from types, as in `policy<reduce::scatter>`.
    policy() = default;
    /// Creates a policy from objects, as in `policy{scatter}`.
    constexpr WARPAGG_HD explicit policy(Tags... tags) requires(sizeof...(Tags) > 0)
        : detail::optional_member<accumulate>(detail::object_of<axis::accumulate>(tags...)) {}
};
/// Deduces the tags: `policy{scatter, skip}` is a `policy<reduce::scatter, idle::skip>`.
template <class... Tags>
policy(Tags...) -> policy<Tags...>;

inline namespace tags {
using warpagg::policy;
}

namespace detail {

/// The policy that adds the limbs of decomposed values: the accumulator's operation in place of its
/// tag, and the other tags of the caller's policy.
template <class Chosen, class... Tags>
struct of_limbs {
    using type = policy<Tags...>;
};
template <class... Chosen, class Next, class... Tags>
struct of_limbs<policy<Chosen...>, Next, Tags...>
    : of_limbs<std::conditional_t<Next::axis == axis::accumulate, policy<Chosen...>, policy<Chosen..., Next>>,
               Tags...> {};
template <class... Chosen>
struct of_limbs<policy<Chosen...>> {
    using type = policy<Chosen...>;
};
template <class Policy>
struct policy_of_limbs;
template <class... Tags>
struct policy_of_limbs<policy<Tags...>> {
    using type = typename of_limbs<policy<typename policy<Tags...>::accumulate::operation>, Tags...>::type;
};

}  // namespace detail

}  // namespace warpagg
