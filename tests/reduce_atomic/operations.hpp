// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// `warp_reduce_atomic` with other operations than the sum, on the `backend` that the including file has
/// chosen and for the value types that it names in TEST_VALUES. Inactive lanes hold the extremes of T, so a
/// wrong neutral element shows; memory of idle warps is as before.

#include "checks.hpp"

namespace {

template <int N, class Op, class T>
void check_operation(const problem<T, Op>& p, const char* what) {
    check<with<policy<Op>>, N>(p, what, as_chosen<T, N, policy<Op>>);
    check<with<policy<reduce::per_lane, Op>>, N>(p, what, always_alone);
    check<with<policy<reduce::shfl_down, Op>>, N>(p, what, {});
    check<with<policy<Op, reduce::scatter>>, N>(p, what, {});
    check<with<policy<idle::add_zeros, Op, reduce::butterfly>>, N>(p, what, {0, 0, true});
    if constexpr (sizeof(T) == 4) check<with<policy<Op, gate::at_least<6>, reduce::redux>>, N>(p, what, {6});
}

template <class Op, class T>
void check_operation(const char* what) {
    check_operation<3>(problem<T, Op>(3, records), what);
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE_TEMPLATE("other operations than the sum", T, TEST_VALUES) {
    check_operation<operation::minimum, T>("minimum");
    check_operation<operation::maximum, T>("maximum");
    check_operation<operation::bit_and, T>("bit_and");
    check_operation<operation::bit_or, T>("bit_or");
    check_operation<operation::bit_xor, T>("bit_xor");
}

TEST_CASE_TEMPLATE("the largest of more values than a warp has lanes", T, TEST_VALUES) {
    using largest = policy<operation::maximum>;
    const problem<T, operation::maximum> p(33, records);
    check<with<largest>, 33>(p, "maximum", as_chosen<T, 33, largest>);
}

TEST_SUITE_END();
