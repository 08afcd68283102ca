// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// How `warp_reduce_atomic` works: one tag per axis, in any order, e.g. `policy{shfl_down, skip}`.

#include <type_traits>

#include "simt/warp.hpp"

#if defined(__CUDA_ARCH__)
#define WARPAGG_TAG static __device__ constexpr
#else
#define WARPAGG_TAG inline constexpr
#endif

namespace warpagg {

enum class axis { reduce, commit, idle, gate };

/// How the lanes' values become one. W is the warp's width, N the number of values.
namespace reduce {
/// No reduction: N atomics per active lane. The baseline.
struct per_lane {
    static constexpr auto of = axis::reduce;
};
/// log2(W) shuffles per value; lane 0 ends with the sums. The paper's Figure 1.
struct shfl_down {
    static constexpr auto of = axis::reduce;
};
/// log2(W) shuffles per value; every lane ends with the sums.
struct butterfly {
    static constexpr auto of = axis::reduce;
};
/// Reduce-scatter: at each of the log2(W) steps a lane hands half of the values it still holds to its
/// partner. About N - 1 + log2(W / N) shuffles for all values together; each lane ends with at most ceil(N /
/// W) sums.
struct scatter {
    static constexpr auto of = axis::reduce;
};
}  // namespace reduce

/// How the sums reach memory.
namespace commit {
/// Lane 0 makes N atomics. The paper.
struct scalar {
    static constexpr auto of = axis::commit;
};
/// One atomic instruction, in which N lanes add to N neighbouring addresses.
struct contiguous {
    static constexpr auto of = axis::commit;
};
}  // namespace commit

/// What happens when no lane is active.
namespace idle {
/// Nothing: a ballot asks first. The paper's Figure 8.
struct skip {
    static constexpr auto of = axis::idle;
};
/// The caller has asked already: there is an active lane.
struct assume_busy {
    static constexpr auto of = axis::idle;
};
/// Zeros are reduced and added all the same. The paper's Figure 7, for comparison.
struct add_zeros {
    static constexpr auto of = axis::idle;
};
}  // namespace idle

/// When the reduction is worth it.
namespace gate {
struct always {
    static constexpr auto of = axis::gate;
};
/// With fewer than K active lanes, each makes its own atomics.
template <unsigned K>
struct at_least {
    static constexpr auto of = axis::gate;
    static constexpr unsigned lanes = K;
};
}  // namespace gate

WARPAGG_TAG reduce::per_lane per_lane{};
WARPAGG_TAG reduce::shfl_down shfl_down{};
WARPAGG_TAG reduce::butterfly butterfly{};
WARPAGG_TAG reduce::scatter scatter{};
WARPAGG_TAG commit::scalar scalar{};
WARPAGG_TAG commit::contiguous contiguous{};
WARPAGG_TAG idle::skip skip{};
WARPAGG_TAG idle::assume_busy assume_busy{};
WARPAGG_TAG idle::add_zeros add_zeros{};
WARPAGG_TAG gate::always always{};
template <unsigned K>
WARPAGG_TAG gate::at_least<K> at_least{};

namespace detail {

template <axis A, class Default, class... Tags>
struct choose {
    using type = Default;
};
template <axis A, class Default, class Tag, class... Tags>
struct choose<A, Default, Tag, Tags...> {
    using type = std::conditional_t<Tag::of == A, Tag, typename choose<A, Default, Tags...>::type>;
};

template <class Reduce>
using commit_after =
    std::conditional_t<std::is_same_v<Reduce, reduce::scatter>, commit::contiguous, commit::scalar>;

template <class Gate>
inline constexpr unsigned least_lanes = 0;
template <unsigned K>
inline constexpr unsigned least_lanes<gate::at_least<K>> = K;

}  // namespace detail

/// A choice on every axis. What no tag names is `scatter`, the commit that suits the reduction, `skip`,
/// `always`.
template <class... Tags>
struct policy {
    template <axis A>
    static constexpr int named = (0 + ... + (Tags::of == A ? 1 : 0));
    static_assert(named<axis::reduce> <= 1,
                  "a policy takes one reduce tag: per_lane, shfl_down, butterfly or scatter");
    static_assert(named<axis::commit> <= 1, "a policy takes one commit tag: scalar or contiguous");
    static_assert(named<axis::idle> <= 1, "a policy takes one idle tag: skip, assume_busy or add_zeros");
    static_assert(named<axis::gate> <= 1, "a policy takes one gate tag: always or at_least<K>");

    using reduce = typename detail::choose<axis::reduce, warpagg::reduce::scatter, Tags...>::type;
    using commit = typename detail::choose<axis::commit, detail::commit_after<reduce>, Tags...>::type;
    using idle = typename detail::choose<axis::idle, warpagg::idle::skip, Tags...>::type;
    using gate = typename detail::choose<axis::gate, warpagg::gate::always, Tags...>::type;

    template <class R, class C>
    static constexpr bool pairs = std::is_same_v<reduce, R>&& std::is_same_v<commit, C>;
    static_assert(!pairs<warpagg::reduce::per_lane, warpagg::commit::contiguous>,
                  "per_lane commits each lane's own values: contiguous has no sums to spread over the lanes");
    static_assert(!pairs<warpagg::reduce::shfl_down, warpagg::commit::contiguous>,
                  "shfl_down leaves the sums in lane 0: contiguous needs butterfly or scatter");
    static_assert(!pairs<warpagg::reduce::scatter, warpagg::commit::scalar>,
                  "scatter leaves the sums spread over the lanes: scalar needs shfl_down or butterfly");
    static_assert(!(std::is_same_v<idle, warpagg::idle::add_zeros> &&
                    std::is_same_v<reduce, warpagg::reduce::per_lane>),
                  "per_lane has no sums, so an idle warp has no zeros to add: take skip");
    static_assert(!(std::is_same_v<idle, warpagg::idle::add_zeros> && detail::least_lanes<gate> > 0),
                  "at_least<K> sends an idle warp to per-lane atomics, so it never adds zeros: take skip");

    policy() = default;
    constexpr WARPAGG_HD explicit policy(Tags...) requires(sizeof...(Tags) > 0) {}
};
template <class... Tags>
policy(Tags...) -> policy<Tags...>;

/// What `warp_reduce_atomic<T, N>` does unless told otherwise: one value is cheapest by `shfl_down`, several
/// are by `scatter` (docs/policies.md has the measurement).
template <class T, int N>
using default_policy = std::conditional_t<N == 1, policy<reduce::shfl_down>, policy<reduce::scatter>>;

}  // namespace warpagg
