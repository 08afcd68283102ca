// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/compiler.hpp"

namespace warpagg::commit {

/// An accessor to a record whose components are contiguous in memory.
template <class T>
struct contiguous_record {
    T* first;  ///< component 0
    /// Returns the address of component i.
    WARPAGG_HD T* operator()(unsigned i) const { return first + i; }
};

/// An accessor to a record whose components are in several arrays: the first `First` components are
/// at `first`, and the others in `rest`. See `warpagg::fields`.
template <class T, int First, int... Rest>
struct field_list {
    T* first;                                                ///< component 0
    field_list<T, Rest...> rest;                             ///< the other fields
    static constexpr int components = (First + ... + Rest);  ///< number of components of all fields
    /// Returns the address of component i.
    WARPAGG_HD T* operator()(unsigned i) const {
        constexpr unsigned here = First;
        return i < here ? first + i : rest(i - here);
    }
};
/// An accessor to a single field.
template <class T, int First>
struct field_list<T, First> {
    T* first;                                 ///< component 0
    static constexpr int components = First;  ///< number of components
    /// Returns the address of component i.
    WARPAGG_HD T* operator()(unsigned i) const { return first + i; }
};

/// One of several arrays that form a destination: N neighboring components. See `warpagg::at`.
template <class T, int N>
struct field {
    T* first;  ///< the first of the N components
};
template <class>
inline constexpr bool is_field = false;  ///< Whether a type is a `field`
template <class T, int N>
inline constexpr bool is_field<field<T, N>> = true;  ///< Whether a type is a `field`

/// The result of `warpagg::fields` for arguments that cannot form a destination.
struct no_field_list {};

/// Returns a destination as an accessor. The destination is a pointer, a span (an object with a const
/// `data()` that gives write access), or already an accessor, as for a structure of arrays.
/// @{
template <class T>
WARPAGG_HD contiguous_record<T> destination(T* p) {
    return {p};
}
template <class S>
requires requires(const S& s) { *s.data() = *s.data(); }  // excludes containers, which would be copied
WARPAGG_HD auto destination(S s) { return destination(s.data()); }
template <class A>
requires requires(A a) { *a(0u); }
WARPAGG_HD A destination(A a) { return a; }
/// @}

/// Is satisfied by pointers, spans and accessors.
template <class Dst>
concept is_destination = requires(Dst dst) {
    destination(dst);
};

}  // namespace warpagg::commit
