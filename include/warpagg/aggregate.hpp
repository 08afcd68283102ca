// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "warp/concept.hpp"

namespace warpagg {

/// Describes a type of yours that consists of N values of one type, so that warpagg adds it as a whole:
///
/// @snippet warp_reduce_atomic.cpp a type of yours
///
/// The type is trivially copyable and has the size and layout of `T[N]`.
template <class R>
struct aggregate_traits;

/// N components of type T: a base class for `aggregate_traits<R>`.
template <class T, int N>
struct aggregate_of {
    using type = T;                  ///< type of a component
    static constexpr int count = N;  ///< number of components
};

/// A type that `aggregate_traits` describes.
template <class R>
concept aggregate = requires {
    typename aggregate_traits<R>::type;
    aggregate_traits<R>::count;
};

namespace detail {

/// The components of an aggregate.
template <aggregate R>
struct components_of {
    using T = typename aggregate_traits<R>::type;
    static constexpr int N = aggregate_traits<R>::count;
    static_assert(sizeof(R) == N * sizeof(T), "aggregate_traits<R> must describe all of R");
    T component[N];
    WARPAGG_HD explicit components_of(const R& value) { std::memcpy(component, &value, sizeof component); }
};

/// The destination `R*` as a pointer to its components; any other destination as it is.
template <aggregate R>
WARPAGG_HD auto destination_of_components(R* dst) {
    return reinterpret_cast<typename aggregate_traits<R>::type*>(dst);
}
template <class Dst>
WARPAGG_HD Dst destination_of_components(Dst dst) {
    return dst;
}

}  // namespace detail

/// @cond deprecated
template <class R>
struct components;
template <class R>
requires requires { typename components<R>::type; }
struct aggregate_traits<R> : components<R> {};
template <class R>  // declared again after its use above, so that only users are warned
struct [[deprecated("specialize aggregate_traits")]] components;
template <class T, int N>
using consists_of [[deprecated("use aggregate_of")]] = aggregate_of<T, N>;
template <class R>
concept composite = aggregate<R>;
/// @endcond

}  // namespace warpagg
