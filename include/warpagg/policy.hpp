// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// How `warp_reduce_atomic` works: one tag per axis, in any order, e.g. `policy{shfl_down, skip}`. What no
/// tag names is chosen for the values' type and number: see default_policy.hpp.

#include "accumulator.hpp"
#include "operation.hpp"
#include "warp/concept.hpp"
#include "detail/tag.hpp"

namespace warpagg {

/// How the lanes' values become one. W is the warp's width, N the number of values.
namespace reduce {

/// Which lanes have the results afterwards.
enum class results_in {
    own_lane,    ///< each lane its own values: nothing was combined
    first_lane,  ///< lane 0 all of them
    every_lane,  ///< every lane all of them
    spread,      ///< each lane some of them: see `scattered_index`
};

/// No reduction, the baseline. Cost: no shuffle, and N atomics per active lane.
struct per_lane {
    static constexpr auto of = axis::reduce;
    static constexpr auto leaves = results_in::own_lane;
};
/// Lane 0 ends with the results. The paper's Figure 1. Cost: N log2(W) shuffles (N = 9 on 32 lanes: 45).
struct shfl_down {
    static constexpr auto of = axis::reduce;
    static constexpr auto leaves = results_in::first_lane;
};
/// Every lane ends with the results. Cost: N log2(W) shuffles.
struct butterfly {
    static constexpr auto of = axis::reduce;
    static constexpr auto leaves = results_in::every_lane;
};
/// Reduce-scatter: at each of the log2(W) steps a lane hands half of the values it still holds to its
/// partner, and ends with at most ceil(N / W) results. Cost: about N - 1 + log2(W / N) shuffles (N = 9 on 32
/// lanes: 12).
struct scatter {
    static constexpr auto of = axis::reduce;
    static constexpr auto leaves = results_in::spread;
};
/// The hardware's own reduction, `redux.sync`: one instruction per value, for integers of 32 bits. A model
/// without it, as the emulators are, takes `butterfly`.
struct redux {
    static constexpr auto of = axis::reduce;
    static constexpr auto leaves = results_in::every_lane;
};

}  // namespace reduce

/// How the results reach memory.
namespace commit {

/// Lane 0 makes them. The paper. Cost: N atomics, one instruction each.
struct scalar {
    static constexpr auto of = axis::commit;
};
/// N lanes make them, at N neighbouring addresses. Cost: N atomics by one instruction, or by ceil(N / W).
struct contiguous {
    static constexpr auto of = axis::commit;
};
/// K neighbouring floats by one atomic instruction (`red.global.add.v2.f32`, `.v4.f32`), what is left by
/// smaller groups. It applies to sums of float in a contiguous record whose first component is aligned to K
/// floats; below compute capability 9.0 and for all else, each component takes an instruction, as with
/// `scalar`. The record lies in global memory. Each component is atomic by itself.
template <unsigned K>
struct packed {
    static_assert(K == 2 || K == 4, "packed<K> takes K = 2 or 4 neighbours");
    static constexpr auto of = axis::commit;
    static constexpr unsigned neighbours = K;  ///< components by one instruction
};
/// Into a block's copy of the destination in shared memory, which is added to memory once: see
/// commit/stage.hpp. The destination is a stage's record.
struct staged {
    static constexpr auto of = axis::commit;
};

}  // namespace commit

/// What happens when no lane is active.
namespace idle {

/// Nothing: a vote asks first. The paper's Figure 8. Cost: one vote.
struct skip {
    static constexpr auto of = axis::idle;
};
/// The caller has asked already. Precondition: there is an active lane; `emulator::checked` verifies it, and
/// CUDA with WARPAGG_CHECKS. Cost: nothing; a gate votes all the same.
struct assume_busy {
    static constexpr auto of = axis::idle;
};
/// Zeros are reduced and added all the same. The paper's Figure 7, for comparison. Cost: no vote, but an idle
/// warp pays for shuffles and atomics.
struct add_zeros {
    static constexpr auto of = axis::idle;
};

}  // namespace idle

/// When the reduction is worth it.
namespace gate {

/// Always. Cost: nothing.
struct always {
    static constexpr auto of = axis::gate;
    static constexpr unsigned lanes = 0;            ///< the fewest active lanes that reduce
    static constexpr unsigned lanes_if_packed = 0;  ///< the same where their commit packs
};
/// Fewer than K active lanes (fewer than Packed, where their commit packs neighbours) make their own atomics,
/// by `packed<4>` unless the policy names `packed<2>` or `scalar`. Cost: one vote, in place of that of
/// `skip`.
template <unsigned K, unsigned Packed = K>
struct at_least {
    static_assert(K > 0, "at_least<K> takes K > 0: without a gate, say always");
    static constexpr auto of = axis::gate;
    static constexpr unsigned lanes = K;                 ///< the fewest active lanes that reduce
    static constexpr unsigned lanes_if_packed = Packed;  ///< the same where their commit packs
};

}  // namespace gate

/// The tag as an object, for `policy{...}`.
/// @{
WARPAGG_TAG reduce::per_lane per_lane{};
WARPAGG_TAG reduce::shfl_down shfl_down{};
WARPAGG_TAG reduce::butterfly butterfly{};
WARPAGG_TAG reduce::scatter scatter{};
WARPAGG_TAG reduce::redux redux{};
WARPAGG_TAG commit::scalar scalar{};
WARPAGG_TAG commit::contiguous contiguous{};
template <unsigned K>
WARPAGG_TAG commit::packed<K> packed{};
WARPAGG_TAG commit::staged staged{};
WARPAGG_TAG idle::skip skip{};
WARPAGG_TAG idle::assume_busy assume_busy{};
WARPAGG_TAG idle::add_zeros add_zeros{};
WARPAGG_TAG gate::always always{};
template <unsigned K, unsigned Packed = K>
WARPAGG_TAG gate::at_least<K, Packed> at_least{};
/// @}

namespace detail {

struct unnamed {};

/// The tag among Tags that is of axis A.
template <axis A, class... Tags>
struct named {
    using type = unnamed;
};
template <axis A, class Tag, class... Tags>
struct named<A, Tag, Tags...> {
    using type = std::conditional_t<Tag::of == A, Tag, typename named<A, Tags...>::type>;
};
template <axis A, class... Tags>
using named_t = typename named<A, Tags...>::type;

/// The object among tags that is of axis A.
template <axis A>
WARPAGG_HD constexpr unnamed object_of() {
    return {};
}
template <axis A, class Tag, class... Tags>
WARPAGG_HD constexpr auto object_of(Tag tag, Tags... tags) {
    if constexpr (Tag::of == A) {
        return tag;
    } else {
        return object_of<A>(tags...);
    }
}

/// A tag's object; nothing where it holds nothing.
template <class Tag, bool = __is_empty(Tag)>
class carried {
  public:
    carried() = default;
    constexpr WARPAGG_HD explicit carried(Tag) {}
    constexpr WARPAGG_HD Tag accumulating() const { return {}; }
};
template <class Tag>
class carried<Tag, false> {
  public:
    carried() = default;
    constexpr WARPAGG_HD explicit carried(Tag tag) : tag_(tag) {}
    constexpr WARPAGG_HD Tag accumulating() const { return tag_; }

  private:
    Tag tag_;
};

template <class Tag, class Default>
using or_default = std::conditional_t<std::is_same_v<Tag, unnamed>, Default, Tag>;

template <class Reduce>
inline constexpr auto leaves = Reduce::leaves;
template <>
inline constexpr auto leaves<unnamed> = reduce::results_in::every_lane;  // whatever suits the commit

template <class Reduce, class Commit>
inline constexpr bool spreads_own_values =
    leaves<Reduce> == reduce::results_in::own_lane&& std::is_same_v<Commit, commit::contiguous>;
template <class Reduce, class Commit>
inline constexpr bool spreads_first_lane =
    leaves<Reduce> == reduce::results_in::first_lane&& std::is_same_v<Commit, commit::contiguous>;
template <class Commit>
inline constexpr bool by_one_lane = std::is_same_v<Commit, commit::scalar>;
template <unsigned K>
inline constexpr bool by_one_lane<commit::packed<K>> = true;
template <class Reduce, class Commit>
inline constexpr bool gathers_spread = leaves<Reduce> == reduce::results_in::spread&& by_one_lane<Commit>;
template <class Gate>
inline constexpr bool is_gated = Gate::lanes > 0;
template <>
inline constexpr bool is_gated<unnamed> = false;

/// Whether sums are kept otherwise than in the values' own type.
template <class Accumulate>
inline constexpr bool is_accumulated = requires {
    typename Accumulate::number;
};

/// Whether a warp's own sum is native all the same.
template <class Accumulate>
inline constexpr bool is_between_warps = requires {
    typename Accumulate::kept;
};

template <class P>
concept is_policy = requires {
    typename P::reduce;
    typename P::gate;
};
}  // namespace detail

/// A set of tags, at most one per axis, in any order. Two of one axis, or a pair that cannot work, does not
/// compile.
///
/// @snippet warp_reduce_atomic.cpp policy
template <class... Tags>
struct policy : detail::carried<detail::named_t<axis::accumulate, Tags...>> {
    /// How many of the tags are of axis A.
    template <axis A>
    static constexpr int count = (0 + ... + (Tags::of == A ? 1 : 0));
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
    static_assert(count<axis::gate> <= 1, "a policy takes one gate tag: always or at_least<K>");

    /// The tag of this axis; a type of no meaning where none is named.
    /// @{
    using operation = detail::named_t<axis::operation, Tags...>;
    using reduce = detail::named_t<axis::reduce, Tags...>;
    using accumulate = detail::named_t<axis::accumulate, Tags...>;
    using commit = detail::named_t<axis::commit, Tags...>;
    using idle = detail::named_t<axis::idle, Tags...>;
    using gate = detail::named_t<axis::gate, Tags...>;
    /// @}

    static_assert(!detail::spreads_own_values<reduce, commit>,
                  "per_lane commits each lane's own values: contiguous has no sums to spread over the lanes");
    static_assert(!detail::spreads_first_lane<reduce, commit>,
                  "shfl_down and cub leave the sums in lane 0: contiguous needs butterfly or scatter");
    static_assert(
        !detail::gathers_spread<reduce, commit>,
        "scatter leaves the sums spread over the lanes: scalar and packed need shfl_down or butterfly");
    static_assert(!(std::is_same_v<idle, warpagg::idle::add_zeros> &&
                    std::is_same_v<reduce, warpagg::reduce::per_lane>),
                  "per_lane has no sums, so an idle warp has no zeros to add: take skip");
    static_assert(!(std::is_same_v<reduce, warpagg::reduce::per_lane> && detail::is_gated<gate>),
                  "per_lane has no reduction for at_least<K> to stand before: take always");
    static_assert(!std::is_same_v<commit, warpagg::commit::staged> ||
                      std::is_same_v<operation, detail::unnamed>,
                  "a stage is added to memory: staged goes with the sum");
    static_assert(!(std::is_same_v<idle, warpagg::idle::add_zeros> && detail::is_gated<gate>),
                  "at_least<K> sends an idle warp to per-lane atomics, so it never adds zeros: take skip");

    static_assert(
        !detail::is_accumulated<accumulate> || count<axis::operation> == 0,
        "f64, compensated, fixed<Q>, binned<K> and exact are ways of keeping a sum: name no operation");
    static_assert(!detail::is_accumulated<accumulate> || !std::is_same_v<commit, warpagg::commit::staged>,
                  "a stage is added to memory as it is: staged goes with native");

    /// From types: `policy<reduce::scatter>`.
    policy() = default;
    /// From objects: `policy{scatter}`.
    constexpr WARPAGG_HD explicit policy(Tags... tags) requires(sizeof...(Tags) > 0)
        : detail::carried<accumulate>(detail::object_of<axis::accumulate>(tags...)) {}
};
/// `policy{scatter, skip}` is a `policy<reduce::scatter, idle::skip>`.
template <class... Tags>
policy(Tags...) -> policy<Tags...>;

namespace detail {

/// The policy by which numbers that values were taken apart into are added.
template <class Chosen, class... Tags>
struct of_numbers {
    using type = policy<Tags...>;
};
template <class... Chosen, class Next, class... Tags>
struct of_numbers<policy<Chosen...>, Next, Tags...>
    : of_numbers<std::conditional_t<Next::of == axis::accumulate, policy<Chosen...>, policy<Chosen..., Next>>,
                 Tags...> {};
template <class... Chosen>
struct of_numbers<policy<Chosen...>> {
    using type = policy<Chosen...>;
};
template <class Policy>
struct policy_of_numbers;
template <class... Tags>
struct policy_of_numbers<policy<Tags...>> {
    using type = typename of_numbers<policy<typename policy<Tags...>::accumulate::operation>, Tags...>::type;
};

}  // namespace detail

}  // namespace warpagg
