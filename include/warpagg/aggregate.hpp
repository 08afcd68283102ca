// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "warp/concept.hpp"

namespace warpagg {

/// Describes an aggregate, a user's type that consists of N numbers of one type. warpagg then adds objects of
/// that type:
///
/// @snippet warp_reduce_atomic.cpp a type of yours
///
/// Specialize it for the type. Preconditions: the type is trivially copyable, and has the size and layout of
/// `T[N]`. A wrong size does not compile.
template <class R>
struct aggregate_traits;

/// The base class of `aggregate_traits<R>` for N components of type T.
template <class T, int N>
struct aggregate_of {
    using type = T;                  ///< type of a component
    static constexpr int count = N;  ///< number of components
};

/// Is satisfied by types that `aggregate_traits` describes.
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

/// Converts a destination `R*` to a pointer to its components. Returns any other destination unchanged.
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
template <class R>  // deprecated only after its use above, so that the header itself gives no warning
struct [[deprecated("specialize aggregate_traits")]] components;
template <class T, int N>
using consists_of [[deprecated("use aggregate_of")]] = aggregate_of<T, N>;
template <class R>
concept composite = aggregate<R>;
/// @endcond

}  // namespace warpagg
