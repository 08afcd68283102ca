// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What `warp_reduce_atomic` promises, on the `backend` that the including file has chosen and for the value
/// types that it names in TEST_VALUES.

#include "reduce_atomic_checks.hpp"

namespace {

template <class Destination, class T>
void check_destination(const problem<T>& p, const char* what) {
    constexpr int n = 9;
    check<without_policy, n, Destination>(p, what, {});
    check<all_deduced, n, Destination>(p, what, {});
    check<tag_objects, n, Destination>(p, what, {});
    check<with<policy<reduce::per_lane>>, n, Destination>(p, what, always_alone);
    check<with<policy<reduce::butterfly, commit::contiguous>>, n, Destination>(p, what, {});
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE_TEMPLATE("warp_reduce_atomic adds the documented tree, whatever the policy", T, TEST_VALUES) {
    check_all<1, T>();
    check_all<2, T>();
    check_all<3, T>();
    check_all<4, T>();
    check_all<9, T>();
    check_all<16, T>();
}

TEST_CASE_TEMPLATE("shfl_down, butterfly and scatter give the same bits", T, TEST_VALUES) {
    check_same_bits<1, T>();
    check_same_bits<3, T>();
    check_same_bits<9, T>();
    check_same_bits<16, T>();
}

TEST_CASE_TEMPLATE("a destination is a pointer, a span or an accessor", T, TEST_VALUES) {
    const problem<T> rows(9, records, 5);
    check_destination<as_pointer>(rows, "pointer");
    check_destination<as_span<9>>(rows, "span");
    check_destination<as_accessor>(rows, "accessor of a record");
    const problem<T> columns(9, structure_of_arrays, 6);
    check_destination<as_accessor>(columns, "accessor of a structure of arrays");
}

TEST_SUITE_END();
