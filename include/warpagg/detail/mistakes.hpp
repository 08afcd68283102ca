// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Compile errors of one sentence for common mistakes in calls. Each function of the library is
/// constrained to calls without a mistake. An overload for all other calls passes the mistake to
/// `explain`. docs/reference/compile_errors.md lists the sentences.

#include "../aggregate.hpp"
#include "../core/axis.hpp"
#include "../core/call_site.hpp"
#include "destination.hpp"

namespace warpagg {

template <class... Tags>
struct policy;  // see policy.hpp

namespace detail {

/// The first mistake in the arguments of a call.
enum class mistake {
    none,
    warp,
    key,
    values,
    active_missing,
    active_not_bool,
    policy,
    destination,
    base,
    destination_const,
    destination_type,
    fields_missing,
    fields_differ,
};

/// Does not compile. The message explains the mistake.
template <mistake Mistake>
WARPAGG_HD void explain() {
    static_assert(Mistake != mistake::warp, "the first argument must be a warp, such as cuda_warp");
    static_assert(Mistake != mistake::key, "the key must be an integer, the index of this lane's record");
    static_assert(
        Mistake != mistake::values,
        "the values must be an array: copy a scalar, a float3 or a std::array into float values[N]");
    static_assert(Mistake != mistake::active_missing,
                  "the argument active is missing: pass whether this lane is active, a bool");
    static_assert(Mistake != mistake::active_not_bool,
                  "active must be a bool, whether this lane is active: an integer or a mask of lanes is not");
    static_assert(Mistake != mistake::policy, "the tags go into one policy: write policy{...}");
    static_assert(Mistake != mistake::destination,
                  "the destination is a pointer, a span or an accessor: of a container, pass its data()");
    static_assert(Mistake != mistake::base,
                  "the base is a pointer to the record of key 0, or an accessor base(key, i) -> T*");
    static_assert(Mistake != mistake::destination_const, "the destination must not be const");
    static_assert(Mistake != mistake::fields_missing,
                  "several arrays are one destination: write fields(at<3>(a), at<2>(b))");
    static_assert(
        Mistake != mistake::fields_differ,
        "all fields must have one type of components: pass float* to each at<N> for values of float");
    static_assert(Mistake != mistake::destination_type,
                  "the destination must have the type of the values: pass float* for values of float");
}

/// Takes the place of an argument that the call does not have.
struct missing {};

/// The type of the components of an array of values or of an aggregate; void for other types.
/// @{
template <class Values>
struct component_of_values {
    using type = void;
};
template <class V, std::size_t N>
struct component_of_values<V[N]> {
    using type = scalar_t<V>;
};
template <aggregate R>
struct component_of_values<R> {
    using type = typename aggregate_traits<R>::type;
};
template <class Values>
using component_t = typename component_of_values<Values>::type;
/// @}

/// Is satisfied by destinations of `warp_reduce_atomic` whose components are T.
template <class Dst, class T>
concept destination_of = requires(Dst dst) {
    { *commit::destination(dst)(0u) } -> std::same_as<T&>;
};

/// Is satisfied by bases of `warp_match_reduce_atomic`.
template <class Base>
concept is_base = requires(Base base) {
    *(base + 0);
}
|| requires(Base base) { *base(0u, 0u); };
/// Is satisfied by bases of `warp_match_reduce_atomic` whose components are T.
template <class Base, class T>
concept base_of = requires(Base base) {
    { *(base + 0) } -> std::same_as<T&>;
}
|| requires(Base base) {
    { *base(0u, 0u) } -> std::same_as<T&>;
};

/// Is satisfied if the components in memory may differ from the values: accumulators, or the record of
/// a stage. The functions of the library check those themselves.
template <class Dst, class Policy>
concept is_indirect = is_accumulated<typename Policy::accumulate> || requires(Dst dst) {
    dst.in_stage();
};

/// Return the mistake in one argument, or in a destination or a base for these values.
/// @{
template <class W>
WARPAGG_HD constexpr mistake mistake_in_warp() {
    return warp<W> ? mistake::none : mistake::warp;
}
template <class Key>
WARPAGG_HD constexpr mistake mistake_in_key() {
    return std::is_integral_v<scalar_t<Key>> ? mistake::none : mistake::key;
}
template <class Values>
WARPAGG_HD constexpr mistake mistake_in_values() {
    return std::is_same_v<component_t<Values>, void> ? mistake::values : mistake::none;
}
template <class W, class Active>
WARPAGG_HD constexpr mistake mistake_in_active() {
    if constexpr (warp<W>) {
        if (std::is_same_v<Active, mask_t<W>> || std::is_same_v<Active, bool>) return mistake::none;
        if (!__is_class(Active)) return mistake::active_not_bool;  // mutate: integer_taken_as_active
        if (!std::convertible_to<Active, mask_t<W>>) return mistake::active_missing;
    }
    return mistake::none;
}
template <class Policy, class At, class... More>
WARPAGG_HD constexpr mistake mistake_in_policy() {
    const bool is_right = is_policy<Policy> && std::is_same_v<At, call_site> && sizeof...(More) == 0;
    return is_right ? mistake::none : mistake::policy;
}
template <class Dst>
WARPAGG_HD constexpr mistake mistake_in_fields() {
    if (commit::is_field<Dst>) return mistake::fields_missing;
    return std::is_same_v<Dst, commit::no_field_list> ? mistake::fields_differ : mistake::none;
}
template <class Dst, class Values, class Policy>
WARPAGG_HD constexpr mistake mistake_in_destination() {
    using T = component_t<Values>;
    if (destination_of<Dst, T> || is_indirect<Dst, Policy>) return mistake::none;
    if (aggregate<Values> && destination_of<Dst, Values>) return mistake::none;
    if (destination_of<Dst, const T>) return mistake::destination_const;
    return commit::is_destination<Dst> ? mistake::destination_type : mistake::destination;
}
template <class Base, class Values, class Policy>
WARPAGG_HD constexpr mistake mistake_in_base() {
    using T = component_t<Values>;
    if (base_of<Base, T> || is_indirect<Base, Policy>) return mistake::none;
    if (aggregate<Values> && base_of<Base, Values>) return mistake::none;
    if (base_of<Base, const T>) return mistake::destination_const;
    return is_base<Base> ? mistake::destination_type : mistake::base;
}
/// @}

/// Returns the first of the mistakes that is not `none`.
template <class... Mistakes>
WARPAGG_HD constexpr mistake first_of(Mistakes... all) {
    mistake first = mistake::none;
    ((first = first == mistake::none ? all : first), ...);
    return first;
}

/// Return the first mistake in a call with arguments of these types.
/// @{
template <class W = missing, class Active = missing, class...>
WARPAGG_HD constexpr mistake mistake_in_skip() {
    return first_of(mistake_in_warp<W>(), mistake_in_active<W, Active>());
}
template <class W = missing, class Dst = missing, class Values = missing, class Active = missing,
          class Policy = policy<>, class At = call_site, class... More>
WARPAGG_HD constexpr mistake mistake_in_reduce() {
    return first_of(mistake_in_warp<W>(), mistake_in_fields<Dst>(), mistake_in_values<Values>(),
                    mistake_in_active<W, Active>(), mistake_in_policy<Policy, At, More...>(),
                    mistake_in_destination<Dst, Values, Policy>());
}
template <class W = missing, class Base = missing, class Key = missing, class Values = missing,
          class Active = missing, class Policy = policy<>, class At = call_site, class... More>
WARPAGG_HD constexpr mistake mistake_in_match_reduce() {
    return first_of(mistake_in_warp<W>(), mistake_in_key<Key>(), mistake_in_values<Values>(),
                    mistake_in_active<W, Active>(), mistake_in_policy<Policy, At, More...>(),
                    mistake_in_base<Base, Values, Policy>());
}
template <class W = missing, class Key = missing, class Active = missing, class...>
WARPAGG_HD constexpr mistake mistake_in_match() {
    return first_of(mistake_in_warp<W>(), mistake_in_key<Key>(), mistake_in_active<W, Active>());
}
template <class Base = missing, class Values = missing, class Policy = policy<>, class At = call_site,
          class... More>
WARPAGG_HD constexpr mistake mistake_in_add() {
    return first_of(mistake_in_values<Values>(), mistake_in_policy<Policy, At, More...>(),
                    mistake_in_base<Base, Values, Policy>());
}
/// @}

/// Are satisfied by calls without a mistake: see the functions above.
/// @{
template <class... Args>
concept skip_call = mistake_in_skip<Args...>()
== mistake::none;
template <class... Args>
concept reduce_call = mistake_in_reduce<Args...>()
== mistake::none;
template <class... Args>
concept match_reduce_call = mistake_in_match_reduce<Args...>()
== mistake::none;
template <class... Args>
concept match_call = mistake_in_match<Args...>()
== mistake::none;
template <class... Args>
concept add_call = mistake_in_add<Args...>()
== mistake::none;
/// @}

/// Takes the place of `matched_lanes` after a mistake, so that calls of `add` report nothing else.
struct not_matched {
    template <class... Args>
    WARPAGG_HD void add(const Args&...) const {}
};

}  // namespace detail
}  // namespace warpagg
