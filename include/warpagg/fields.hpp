// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// A destination that consists of several arrays: `fields`.

#include "detail/destination.hpp"

namespace warpagg {

namespace detail {
template <class T, int... N>
WARPAGG_HD void one_type(commit::field<T, N>...) {}
/// Is satisfied by fields with one type of components.
template <class... Fields>
concept one_type_of_fields = requires(Fields... all) {
    one_type(all...);
};
}  // namespace detail

/// Returns the field of the N components at `first`. Precondition: N > 0.
template <int N, class T>
WARPAGG_HD commit::field<T, N> at(T* first) {
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
WARPAGG_HD commit::field_list<T, N> fields(commit::field<T, N> last) {
    return {last.first};
}
template <class T, int N, int... Rest>
requires(sizeof...(Rest) > 0)
    WARPAGG_HD commit::field_list<T, N, Rest...> fields(commit::field<T, N> first,
                                                        commit::field<T, Rest>... rest) {
    return {first.first, fields(rest...)};
}
/// @}

/// Takes other arguments, so that only the call with the destination reports the mistake.
template <class... Args>
requires(!detail::one_type_of_fields<Args...>) WARPAGG_HD commit::no_field_list fields(const Args&...) {
    return {};
}

}  // namespace warpagg
