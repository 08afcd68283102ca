// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/compiler.hpp"

namespace warpagg::commit {

/// A record that is contiguous in memory, as an accessor.
template <class T>
struct contiguous_record {
    T* first;  ///< component 0
    /// Component i.
    WARPAGG_HD T* operator()(unsigned i) const { return first + i; }
};

/// A destination as an accessor, which returns the address of component i. The destination is a
/// pointer, a span (anything with `data()`), or an accessor already (for a structure of arrays).
/// @{
template <class T>
WARPAGG_HD contiguous_record<T> destination(T* p) {
    return {p};
}
template <class S>
requires requires(const S& s) { *s.data() = *s.data(); }  // not a container, whose copy this would be
WARPAGG_HD auto destination(S s) { return destination(s.data()); }
template <class A>
requires requires(A a) { *a(0u); }
WARPAGG_HD A destination(A a) { return a; }
/// @}

/// A pointer, a span or an accessor.
template <class Dst>
concept is_destination = requires(Dst dst) {
    destination(dst);
};

}  // namespace warpagg::commit
