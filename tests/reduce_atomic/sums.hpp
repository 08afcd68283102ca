// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What `warp_reduce_atomic` promises, on the `backend` that the including file has chosen and for the value
/// types that it names in TEST_VALUES.

#include "checks.hpp"
#if defined(__CUDACC__)
#include "../support/half_pairs.hpp"
#endif

namespace {

/// The tags as objects, in device code: nvcc must not look for them in the host's memory.
struct tag_objects {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        warpagg::warp_reduce_atomic(w, dst, v, active, warpagg::policy{warpagg::shfl_down});
    }
};
struct gate_objects {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        const warpagg::policy how{warpagg::at_least<4>, warpagg::contiguous, warpagg::skip,
                                  warpagg::butterfly};
        warpagg::warp_reduce_atomic(w, dst, v, active, how);
    }
};

template <int N, class T>
void check_reductions() {
    const problem<T> p(N, records);
    check<without_policy, N>(p, "no policy", as_chosen<T, N, policy<>>);
    check<with<warpagg::default_policy<T, N>>, N>(p, "default_policy", as_chosen<T, N, policy<>>);
    check<with<policy<reduce::per_lane>>, N>(p, "per_lane", always_alone);
    check<with<policy<reduce::shfl_down>>, N>(p, "shfl_down", {});
    check<with<policy<reduce::butterfly>>, N>(p, "butterfly", {});
    check<with<policy<reduce::scatter>>, N>(p, "scatter", {});
}

template <int N, class T>
void check_idle_rules() {
    const problem<T> p(N, records);
    constexpr rule touched{0, 0, true};
    check<with<policy<idle::add_zeros, reduce::shfl_down>>, N>(p, "add_zeros shfl_down", touched);
    check<with<policy<commit::contiguous, idle::add_zeros, reduce::butterfly>>, N>(
        p, "contiguous add_zeros butterfly", touched);
    check<with<policy<reduce::scatter, idle::add_zeros>>, N>(p, "scatter add_zeros", touched);

    check<asked_first<policy<reduce::shfl_down, commit::scalar, idle::assume_busy, gate::always>>, N>(
        p, "shfl_down scalar assume_busy always", {});
    check<asked_first<policy<idle::assume_busy, reduce::butterfly, commit::scalar>>, N>(
        p, "assume_busy butterfly scalar", {});
    check<asked_first<policy<gate::always, commit::contiguous, idle::assume_busy, reduce::scatter>>, N>(
        p, "always contiguous assume_busy scatter", {});
    check<with<policy<idle::skip, commit::scalar, reduce::per_lane>>, N>(p, "skip scalar per_lane",
                                                                         always_alone);
}

template <int N, class T>
void check_gates() {
    const problem<T> p(N, records);
    check<with<policy<gate::at_least<1>, reduce::scatter>>, N>(p, "at_least<1> scatter", {1});
    check<with<policy<gate::at_least<2>, reduce::shfl_down>>, N>(p, "at_least<2> shfl_down", {2});
    check<with<policy<reduce::butterfly, gate::at_least<8, 3>, commit::contiguous>>, N>(
        p, "butterfly at_least<8, 3> contiguous", {8, 3});
    check<asked_first<policy<reduce::scatter, gate::at_least<17>, idle::assume_busy>>, N>(
        p, "scatter at_least<17> assume_busy", {17});
    check<with<policy<gate::at_least<5, 32>, reduce::butterfly>>, N>(p, "at_least<5, 32> butterfly", {5, 32});
    check<with<policy<gate::at_least<width + 1>, reduce::scatter>>, N>(p, "at_least<W + 1> scatter",
                                                                       always_alone);
    check<gate_objects, N>(p, "at_least<4> contiguous skip butterfly, as objects", {4});
}

template <class Destination, class T>
void check_destination(const problem<T>& p, const char* what) {
    constexpr int n = 9;
    check<without_policy, n, Destination>(p, what, as_chosen<T, n, policy<>>);
    check<all_deduced, n, Destination>(p, what, as_chosen<T, n, policy<>>);
    check<tag_objects, n, Destination>(p, what, {});
    check<with<policy<reduce::per_lane>>, n, Destination>(p, what, always_alone);
    check<with<policy<reduce::butterfly, commit::contiguous>>, n, Destination>(p, what, {});
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE_TEMPLATE("warp_reduce_atomic adds the documented tree, whatever the reduction", T, TEST_VALUES) {
    check_reductions<1, T>();
    check_reductions<2, T>();
    check_reductions<3, T>();
    check_reductions<9, T>();
    check_reductions<16, T>();
}

TEST_CASE_TEMPLATE("an idle warp is skipped, assumed away, or adds zeros", T, TEST_VALUES) {
    check_idle_rules<1, T>();
    check_idle_rules<4, T>();
}

TEST_CASE_TEMPLATE("a gate sends few lanes to atomics of their own", T, TEST_VALUES) {
    check_gates<1, T>();
    check_gates<9, T>();
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
    check_destination<as_fields<9>>(rows, "fields");
    const problem<T> columns(9, structure_of_arrays, 6);
    check_destination<as_accessor>(columns, "accessor of a structure of arrays");
}

TEST_SUITE_END();
