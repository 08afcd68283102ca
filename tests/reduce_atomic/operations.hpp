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
    if constexpr (std::is_integral_v<T> && sizeof(T) == 4)
        check<with<policy<Op, gate::at_least<6>, reduce::redux>>, N>(p, what, {6});
}

template <class Op, class T>
void check_operation(const char* what) {
    check_operation<3>(problem<T, Op>(3, records), what);
}

/// Replaces one value of an active lane of each case by NaN. The case's component is then NaN, and the
/// others are as before.
template <class Policy, class Op, class T>
void check_nan_with(problem<T, Op> p, const char* what) {
    const auto expected = memory_after<with<Policy>, 3>(p);
    std::vector<bool> is_nan(expected.size(), false);
    for (unsigned c = 0; c < p.cases; ++c)
        for (unsigned lane = 0; lane < width; ++lane) {
            if (!p.is_active(c, lane)) continue;
            const T nan = std::numeric_limits<T>::quiet_NaN();
            p.values[(c * 3 + c % 3) * width + lane] = c % 2 == 0 ? nan : -nan;
            is_nan[p.where.at(c, c % 3)] = true;
            break;
        }
    const auto after = memory_after<with<Policy>, 3>(p);
    INFO(std::string(what));
    unsigned different = 0;
    for (std::size_t i = 0; i < after.size(); ++i)
        different += is_nan[i] ? !std::isnan(after[i]) : !same_bits(after[i], expected[i]);
    CHECK(different == 0);
}
template <class Op, class T>
void check_nan(const char* what) {
    const problem<T, Op> p(3, records);
    check_nan_with<policy<Op>>(p, what);
    check_nan_with<policy<Op, reduce::per_lane>>(p, what);
    check_nan_with<policy<Op, reduce::scatter>>(p, what);
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE_TEMPLATE("other operations than the sum", T, TEST_VALUES) {
    check_operation<operation::minimum, T>("minimum");
    check_operation<operation::maximum, T>("maximum");
    if constexpr (std::is_integral_v<T>) {
        check_operation<operation::bit_and, T>("bit_and");
        check_operation<operation::bit_or, T>("bit_or");
        check_operation<operation::bit_xor, T>("bit_xor");
    }
}

TEST_CASE_TEMPLATE("minimum and maximum of floats keep NaN", T, TEST_VALUES) {
    if constexpr (std::is_floating_point_v<T>) {
        check_nan<operation::minimum, T>("minimum");
        check_nan<operation::maximum, T>("maximum");
    }
}

TEST_CASE_TEMPLATE("the largest of more values than a warp has lanes", T, TEST_VALUES) {
    using largest = policy<operation::maximum>;
    constexpr int n = width + 1;
    const problem<T, operation::maximum> p(n, records);
    check<with<largest>, n>(p, "maximum", as_chosen<T, n, largest>);
}

TEST_SUITE_END();
