// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// How results reach memory: one by one, in one row, packed, by way of a stage; on the `backend` that the
/// including file has chosen and for the value types that it names in TEST_VALUES.

#include "checks.hpp"

namespace {

/// Numbers of values that leave a rest of 1, 2 and 3 beyond groups of four, or none.
template <unsigned K, class Destination, int N, class T, class Scope = scope::device>
void check_packed(const problem<T>& p, const char* what) {
    using packed = commit::packed<K>;
    check<with<policy<packed, Scope>>, N, Destination>(p, what, as_chosen<T, N, policy<packed>>);
    check<with<policy<packed, Scope, reduce::shfl_down>>, N, Destination>(p, what, {});
    check<with<policy<packed, Scope, reduce::butterfly, idle::add_zeros>>, N, Destination>(p, what,
                                                                                           {0, 0, true});
    check<with<policy<packed, Scope, reduce::per_lane>>, N, Destination>(p, what, always_alone);
}

/// A record at each alignment: every fourth can be packed by fours.
template <int N, class T>
void check_packed_records() {
    const problem<T> p(N, records);
    INFO("records, of alignments of all kinds");
    check_packed<2, as_pointer, N>(p, "packed<2>");
    check_packed<4, as_pointer, N>(p, "packed<4>");
}

// ------------------------------------------------------------------------------------------- by a stage

/// Adds every case's values to its record twice, by way of a copy of the whole memory.
template <class T, int N, class Policy>
struct add_all_staged {
    const T* values;
    const unsigned* active;
    T* memory;
    layout where;
    unsigned cases;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        const mask_t<W> everyone(true);
        const auto lane = w.lane();
        T* const copy = backend::shared<T>(w, where.size);
        for (unsigned row = 0; row < where.size; row += W::size)
            w.store_row(copy, row, value_t<W, T>(T(7)), lane + row < where.size);
        backend::barrier(w);
        const warpagg::stage<T> block(memory, copy, where.size);
        constexpr unsigned warps = 3;  // this one does the work of three
        for (unsigned warp = 0; warp < warps; ++warp) block.clear(w, warp, warps);
        backend::barrier(w);
        for (unsigned step = 0; step < 2 * cases; ++step) {
            const unsigned c = step % cases;
            value_t<W, T> v[N];
            for (unsigned i = 0; i < N; ++i) v[i] = w.load(values + (c * N + i) * W::size, lane, everyone);
            const mask_t<W> adds = w.load(active + c * W::size, lane, everyone) != 0u;
            warpagg::warp_reduce_atomic<T, N>(w, block.record(where.at(c, 0)), v, adds, Policy{});
        }
        backend::barrier(w);
        for (unsigned warp = 0; warp < warps; ++warp) block.flush(w, warp, warps);
    }
};

template <class Policy, int N, class T>
void check_staged(const char* what) {
    const problem<T> p(N, records);
    backend::memory<T> values(p.values);
    backend::memory<unsigned> active(p.active);
    backend::memory<T> memory(p.before);
    backend::launch(
        add_all_staged<T, N, Policy>{values.data(), active.data(), memory.data(), p.where, p.cases});

    expectation<T> expected(p.before);
    for (unsigned c = 0; c < p.cases; ++c)
        for (unsigned i = 0; i < N; ++i) {
            if (p.own_values(c, i).empty()) continue;
            const T sum = p.tree(c, i);
            const T copy = combined(operation::sum{}, T{} + sum, sum);
            T& result = expected.value[p.where.at(c, i)];
            if (copy != T{}) result = combined(operation::sum{}, result, copy);  // a zero is not added
        }
    INFO(std::string(what), ", N = ", N);
    CHECK(expected.first_difference(memory.download()) == "");
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE_TEMPLATE("butterfly's results by one lane or by all", T, TEST_VALUES) {
    const problem<T> p(9, records);
    check<with<policy<reduce::butterfly, commit::scalar>>, 9>(p, "scalar", {});
    check<with<policy<commit::contiguous, reduce::butterfly>>, 9>(p, "contiguous", {});
    check<with<policy<commit::scalar>>, 9>(p, "scalar alone", as_chosen<T, 9, policy<commit::scalar>>);
}

TEST_CASE_TEMPLATE("packed commits", T, TEST_VALUES) {
    check_packed_records<1, T>();
    check_packed_records<4, T>();
    check_packed_records<7, T>();
    check_packed_records<10, T>();
}

TEST_CASE_TEMPLATE("packed commits of records that are not contiguous", T, TEST_VALUES) {
    const problem<T> p(5, structure_of_arrays);
    check_packed<4, as_accessor, 5>(p, "packed<4>, structure of arrays");
    const problem<T> q(6, records);
    check_packed<4, as_span<6>, 6>(q, "packed<4>, spans");
}

TEST_CASE_TEMPLATE("packed commits of fields", T, TEST_VALUES) {
    const problem<T> p(9, records);
    check_packed<4, as_fields<9>, 9>(p, "packed<4>, fields");
}

TEST_CASE_TEMPLATE("commits in a scope", T, TEST_VALUES) {
    const problem<T> p(9, records);
    check<with<policy<scope::block>>, 9>(p, "block", as_chosen<T, 9, policy<scope::block>>);
    check<with<policy<scope::system, reduce::scatter>>, 9>(p, "system", {});
    check_packed<4, as_pointer, 9, T, scope::block>(p, "packed<4>, block");
}

TEST_CASE_TEMPLATE("staged commits", T, TEST_VALUES) {
    using commit::staged;
    check_staged<policy<staged, reduce::shfl_down>, 1, T>("shfl_down");
    check_staged<policy<reduce::scatter, staged>, 9, T>("scatter");
    check_staged<policy<reduce::butterfly, staged>, 9, T>("butterfly");
}

TEST_SUITE_END();
