// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/compiler.hpp"

namespace warpagg::commit {

/// Where component i of a record lies, for a record that is contiguous in memory.
template <class T>
struct contiguous_record {
    T* first;  ///< component 0
    /// Component i.
    WARPAGG_HD T* operator()(unsigned i) const { return first + i; }
};

/// Any destination as an accessor: a pointer, something with `data()` (a span), or an accessor already,
/// called with the component's number for its address (structure-of-arrays gradients).
/// @{
template <class T>
WARPAGG_HD contiguous_record<T> destination(T* p) {
    return {p};
}
template <class S>
requires requires(const S& s) { *s.data() = *s.data(); }  // not a container's: that would be a copy's
WARPAGG_HD auto destination(S s) { return destination(s.data()); }
template <class A>
requires requires(A a) { *a(0u); }
WARPAGG_HD A destination(A a) { return a; }
/// @}

/// Whether it is a destination.
template <class Dst>
concept is_destination = requires(Dst dst) {
    destination(dst);
};

}  // namespace warpagg::commit
