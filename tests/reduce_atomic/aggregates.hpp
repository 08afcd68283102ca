// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// `warp_reduce_atomic` of types that consist of numbers, on the `backend` that the including file has
/// chosen: not `lanes`, which holds numbers only.

#include "checks.hpp"

namespace {

struct vec3 {
    float x, y, z;
};
struct particle {
    vec3 position;
    float charge;
};
struct moments {
    double sum, sum_of_squares;
};

}  // namespace

template <>
struct warpagg::aggregate_traits<particle> : warpagg::aggregate_of<float, 4> {};
template <>
struct warpagg::aggregate_traits<moments> : warpagg::aggregate_of<double, 2> {};

namespace {

template <class R>
WARPAGG_HD R* as_aggregate(typename warpagg::aggregate_traits<R>::type* p) {
    return reinterpret_cast<R*>(p);
}
template <class R, class Dst>
WARPAGG_HD Dst as_aggregate(Dst dst) {
    return dst;
}

/// Hands the N values over as one R; and a record as one, if it is named by a pointer.
template <class R, class Policy>
struct as_a_whole {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        R value;
        static_assert(sizeof value == sizeof v);
        std::memcpy(&value, v, sizeof value);
        if constexpr (std::is_same_v<Policy, policy<>>) {
            warpagg::warp_reduce_atomic(w, as_aggregate<R>(dst), value, active);
        } else {
            warpagg::warp_reduce_atomic(w, as_aggregate<R>(dst), value, active, Policy{});
        }
    }
};

template <class R, class Destination>
void check_components(layout (*place)(unsigned, unsigned), const char* what) {
    using T = typename warpagg::aggregate_traits<R>::type;
    constexpr int n = warpagg::aggregate_traits<R>::count;
    const problem<T> p(n, place);
    check<as_a_whole<R, policy<>>, n, Destination>(p, what, as_chosen<T, n, policy<>>);
    check<as_a_whole<R, policy<reduce::shfl_down>>, n, Destination>(p, what, {});
    check<as_a_whole<R, policy<reduce::per_lane>>, n, Destination>(p, what, always_alone);
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE("a type that consists of numbers is added as a whole") {
    check_components<particle, as_pointer>(records, "particle, pointer");
    check_components<particle, as_accessor>(structure_of_arrays, "particle, structure of arrays");
    check_components<moments, as_pointer>(records, "moments, pointer");
}

TEST_SUITE_END();
