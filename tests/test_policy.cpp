// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What a policy's tags choose. Mostly said to the compiler; what it must refuse is in compile_fail/.

#include <doctest/doctest.h>

#include <cstdint>
#include <type_traits>
#include <warpagg/policy.hpp>

namespace {

using warpagg::policy;
namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace idle = warpagg::idle;
namespace gate = warpagg::gate;

template <class Policy, class Reduce, class Commit, class Idle, class Gate>
constexpr bool chooses =
    std::is_same_v<typename Policy::reduce, Reduce>&& std::is_same_v<typename Policy::commit, Commit>&&
        std::is_same_v<typename Policy::idle, Idle>&& std::is_same_v<typename Policy::gate, Gate>;

/// All 24 orders of four tags.
template <class A, class B, class C, class D, class F>
void for_each_order(F f) {
    const auto starting_with = [&]<class W, class X, class Y, class Z>(W*, X*, Y*, Z*) {
        f(policy<W, X, Y, Z>{});
        f(policy<W, X, Z, Y>{});
        f(policy<W, Y, X, Z>{});
        f(policy<W, Y, Z, X>{});
        f(policy<W, Z, X, Y>{});
        f(policy<W, Z, Y, X>{});
    };
    A* a = nullptr;
    B* b = nullptr;
    C* c = nullptr;
    D* d = nullptr;
    starting_with(a, b, c, d);
    starting_with(b, a, c, d);
    starting_with(c, a, b, d);
    starting_with(d, a, b, c);
}

template <class Reduce, class Commit, class Idle, class Gate>
int orders_that_choose() {
    int right = 0;
    for_each_order<Reduce, Commit, Idle, Gate>(
        [&]<class P>(P) { right += chooses<P, Reduce, Commit, Idle, Gate> ? 1 : 0; });
    return right;
}

}  // namespace

TEST_SUITE_BEGIN("policy");

TEST_CASE("tags choose the same in any order") {
    CHECK(orders_that_choose<reduce::butterfly, commit::contiguous, idle::assume_busy, gate::at_least<3>>() ==
          24);
    CHECK(orders_that_choose<reduce::shfl_down, commit::scalar, idle::add_zeros, gate::always>() == 24);
    CHECK(orders_that_choose<reduce::per_lane, commit::scalar, idle::skip, gate::always>() == 24);
    CHECK(orders_that_choose<reduce::scatter, commit::contiguous, idle::skip, gate::at_least<33>>() == 24);
}

TEST_CASE("what no tag names") {
    CHECK(chooses<policy<>, reduce::scatter, commit::contiguous, idle::skip, gate::always>);
    CHECK(chooses<policy<reduce::shfl_down>, reduce::shfl_down, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<policy<reduce::butterfly>, reduce::butterfly, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<policy<reduce::per_lane>, reduce::per_lane, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<policy<reduce::scatter>, reduce::scatter, commit::contiguous, idle::skip, gate::always>);
    CHECK(chooses<policy<commit::contiguous>, reduce::scatter, commit::contiguous, idle::skip, gate::always>);
    CHECK(
        chooses<policy<idle::add_zeros>, reduce::scatter, commit::contiguous, idle::add_zeros, gate::always>);
    CHECK(chooses<policy<gate::at_least<5>>, reduce::scatter, commit::contiguous, idle::skip,
                  gate::at_least<5>>);
}

TEST_CASE("tag objects spell the same types") {
    using written =
        decltype(policy{warpagg::at_least<4>, warpagg::butterfly, warpagg::contiguous, warpagg::assume_busy});
    CHECK(
        std::is_same_v<written,
                       policy<gate::at_least<4>, reduce::butterfly, commit::contiguous, idle::assume_busy>>);
    CHECK(std::is_same_v<decltype(policy{warpagg::per_lane, warpagg::scalar, warpagg::skip}),
                         policy<reduce::per_lane, commit::scalar, idle::skip>>);
    CHECK(std::is_same_v<decltype(policy{warpagg::add_zeros, warpagg::shfl_down, warpagg::always}),
                         policy<idle::add_zeros, reduce::shfl_down, gate::always>>);
    CHECK(std::is_same_v<decltype(policy{warpagg::scatter}), policy<reduce::scatter>>);
    CHECK(std::is_empty_v<written>);
}

TEST_CASE_TEMPLATE("the default per number of values", T, float, double, std::int32_t, std::uint32_t) {
    using one = warpagg::default_policy<T, 1>;
    using few = warpagg::default_policy<T, 2>;
    using many = warpagg::default_policy<T, 40>;
    CHECK(chooses<one, reduce::shfl_down, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<few, reduce::scatter, commit::contiguous, idle::skip, gate::always>);
    CHECK(chooses<many, reduce::scatter, commit::contiguous, idle::skip, gate::always>);
}

TEST_SUITE_END();
