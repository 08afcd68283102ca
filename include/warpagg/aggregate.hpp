// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "warp/concept.hpp"

namespace warpagg {

/// Says of which numbers a type of yours consists, so that its values can be added as a whole:
///
/// @snippet warp_reduce_atomic.cpp a type of yours
///
/// The type is trivially copyable and has the size and layout of `T[N]`.
template <class R>
struct components;

/// Of N numbers of type T: a base for `components<R>`.
template <class T, int N>
struct consists_of {
    using type = T;                  ///< of a number
    static constexpr int count = N;  ///< how many numbers
};

/// A type of which `components` tells.
template <class R>
concept composite = requires {
    typename components<R>::type;
    components<R>::count;
};

namespace detail {

/// A composite value as its numbers.
template <composite R>
struct numbers_of {
    using T = typename components<R>::type;
    static constexpr int N = components<R>::count;
    static_assert(sizeof(R) == N * sizeof(T), "components<R> must tell of all that R consists of");
    T number[N];
    WARPAGG_HD explicit numbers_of(const R& value) { std::memcpy(number, &value, sizeof number); }
};

/// The destination `R*` as one of numbers; any other as it is.
template <composite R>
WARPAGG_HD auto destination_of_numbers(R* dst) {
    return reinterpret_cast<typename components<R>::type*>(dst);
}
template <class Dst>
WARPAGG_HD Dst destination_of_numbers(Dst dst) {
    return dst;
}

}  // namespace detail
}  // namespace warpagg
