// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// A destination that consists of several arrays: `fields`.

#include "detail/destination.hpp"

namespace warpagg {

/// N neighboring components of a record, at one address.
template <class T, int N>
struct field {
    T* first;  ///< the first of the N components
};

namespace detail {
/// Returns the fields of `rest` after a field of N components at `first`.
template <int N, class T, int... Rest>
WARPAGG_HD commit::field_list<T, N, Rest...> prepended(T* first, const commit::field_list<T, Rest...>& rest) {
    return {first, rest};
}
}  // namespace detail

/// Returns the field of the N components at `first`. Precondition: N > 0.
template <int N, class T>
WARPAGG_HD field<T, N> at(T* first) {
    static_assert(N > 0, "at<N>(address) takes N > 0 components");
    return {first};
}

/// Returns a destination whose components are in several arrays, as in
/// `fields(at<3>(&color[3 * id]), at<2>(&mean[id].x))`: values 0 to 2 go to the first field, and
/// values 3 and 4 to the second one. All fields have one type of components. The numbers of components
/// must add up to the number of values; otherwise the call does not compile.
///
/// Cost: with results spread over the lanes, a few selects per lane. Where lanes commit their own
/// values, each field is committed by `packed` if its address is aligned.
///
/// @snippet warp_reduce_atomic.cpp fields
/// @{
template <class T, int N>
WARPAGG_HD commit::field_list<T, N> fields(field<T, N> last) {
    return {last.first};
}
template <class T, int N, class... Rest>
WARPAGG_HD auto fields(field<T, N> first, Rest... rest) {
    return detail::prepended<N>(first.first, fields(rest...));
}
/// @}

}  // namespace warpagg
