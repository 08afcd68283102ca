// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The defaults of a policy, which come from measurements. docs/reference/policies.md lists them.

#include "policy.hpp"

namespace warpagg {

namespace detail {

/// The reduction and the gate for N values of T. Source: times of whole kernels (bench/kernels) and of
/// atomics alone (bench/atomics) on compute capability 9.0. Other devices use the same choice; those
/// below 9.0 never pack.
template <class T, int N>
struct measured {
    // The general case, for pairs of 16-bit floats and other types of 32 bits.
    using reduce = std::conditional_t<N == 1, warpagg::reduce::shfl_down, warpagg::reduce::scatter>;
    using gate = std::conditional_t<(N > 1 && N <= 4), gate::at_least<2>, gate::always>;
};

// Small records: few lanes commit faster on their own. From 9 values on, a reduction takes so many
// shuffles that the gate's test pays in kernels with few active lanes; it costs little in others.
template <int N>
struct measured<float, N> : measured<void, N> {
    static constexpr unsigned lanes = N == 2 ? 3 : N < 5 ? 2 : 8;
    static constexpr unsigned lanes_if_packed = N == 2 ? 5 : N == 3 ? 3 : N == 4 ? 6 : 16;
    using gate =
        std::conditional_t<N == 1 || (N > 4 && N < 9), gate::always, gate::at_least<lanes, lanes_if_packed>>;
};

template <class T, int N>
requires(std::is_integral_v<T> && sizeof(T) == 4) struct measured<T, N> {
    using reduce = std::conditional_t<N <= 32, warpagg::reduce::redux, warpagg::reduce::scatter>;
    using gate = gate::always;
};

template <class T, int N>
requires(sizeof(T) == 8 && std::is_arithmetic_v<T>) struct measured<T, N> : measured<void, N> {
    using gate = std::conditional_t<N <= 16, gate::at_least<N == 1 ? 4 : N <= 4 ? 3 : 2>, gate::always>;
};

/// The measured reduction, or a similar one if the commit cannot use its result placement.
template <class Commit, class Measured>
struct reduce_for {
    using type = Measured;
};
template <class Measured>
using not_spread =
    std::conditional_t<Measured::placement == reduce::result_placement::spread, reduce::shfl_down, Measured>;
template <class Measured>
struct reduce_for<commit::scalar, Measured> {
    using type = not_spread<Measured>;
};
template <unsigned K, class Measured>
struct reduce_for<commit::packed<K>, Measured> {
    using type = not_spread<Measured>;
};
template <class Measured>
struct reduce_for<commit::contiguous, Measured> {
    using type = std::conditional_t<Measured::placement == reduce::result_placement::first_lane,
                                    reduce::scatter, Measured>;
};

/// The commit with the fewest instructions for the result placement.
template <class Reduce>
using commit_after = std::conditional_t<Reduce::placement == reduce::result_placement::spread ||
                                            Reduce::placement == reduce::result_placement::every_lane,
                                        commit::contiguous, commit::scalar>;

/// A policy with the caller's tags, in which defaults fill the other axes, for N values of T. If the
/// caller names a reduction but no gate, the gate is `always`.
template <class T, int N, class Policy>
struct resolved_policy {
    static_assert(
        or_default<typename Policy::operation, warpagg::operation::sum>::template suits<T>,
        "memory has sums of 32 bits and more, and minimum, maximum, bit_and, bit_or and bit_xor of integers "
        "of 32 and 64 bits");
    using unscoped = or_default<typename Policy::operation, warpagg::operation::sum>;
    using operation =
        std::conditional_t<std::is_same_v<typename Policy::scope, unset> ||
                               std::is_same_v<typename Policy::scope, warpagg::scope::device>,
                           unscoped, warpagg::operation::scoped<unscoped, typename Policy::scope>>;
    using reduce =
        or_default<typename Policy::reduce,
                   typename reduce_for<typename Policy::commit, typename measured<T, N>::reduce>::type>;
    using commit = or_default<typename Policy::commit, commit_after<reduce>>;
    /// The commit of each lane's own values if too few lanes are active to reduce.
    using ungated_commit = std::conditional_t<std::is_same_v<typename Policy::commit, unset> ||
                                                  !by_one_lane<typename Policy::commit>,
                                              warpagg::commit::packed<4>, typename Policy::commit>;
    using idle = or_default<typename Policy::idle, warpagg::idle::skip>;
    static constexpr bool measured_gate =
        // mutate: named_reduction_is_gated
        std::is_same_v<typename Policy::reduce, unset> && !std::is_same_v<idle, warpagg::idle::add_zeros>;
    using gate =
        or_default<typename Policy::gate,
                   std::conditional_t<measured_gate, typename measured<T, N>::gate, warpagg::gate::always>>;
};

}  // namespace detail

/// The policy that `warp_reduce_atomic` uses by default for N values of T.
template <class T, int N, class Resolved = detail::resolved_policy<T, N, policy<>>>
using default_policy = policy<typename Resolved::reduce, typename Resolved::commit, typename Resolved::idle,
                              typename Resolved::gate>;

}  // namespace warpagg
