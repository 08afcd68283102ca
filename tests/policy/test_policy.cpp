// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What a policy's tags choose. Mostly said to the compiler; what it must refuse is in compile_fail/.

#include <doctest/doctest.h>

#include <cstdint>
#include <type_traits>
#include <warpagg/default_policy.hpp>

namespace {

using warpagg::policy;
namespace operation = warpagg::operation;
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

template <class T, int N, class Gate>
constexpr bool scatters =
    chooses<warpagg::default_policy<T, N>, reduce::scatter, commit::contiguous, idle::skip, Gate>;

}  // namespace

TEST_SUITE_BEGIN("policy");

TEST_CASE("tags choose the same in any order") {
    CHECK(orders_that_choose<reduce::butterfly, commit::contiguous, idle::assume_busy, gate::at_least<3>>() ==
          24);
    CHECK(orders_that_choose<reduce::shfl_down, commit::scalar, idle::add_zeros, gate::always>() == 24);
    CHECK(orders_that_choose<reduce::per_lane, commit::scalar, idle::skip, gate::always>() == 24);
    CHECK(orders_that_choose<reduce::scatter, commit::contiguous, idle::skip, gate::at_least<33>>() == 24);
}

TEST_CASE("the tags of an axis are found, or none is") {
    using nothing = warpagg::detail::unset;
    CHECK(chooses<policy<>, nothing, nothing, nothing, nothing>);
    CHECK(chooses<policy<commit::packed<2>>, nothing, commit::packed<2>, nothing, nothing>);
    CHECK(chooses<policy<gate::at_least<2, 5>, reduce::redux>, reduce::redux, nothing, nothing,
                  gate::at_least<2, 5>>);
    CHECK(std::is_same_v<policy<>::operation, nothing>);
    CHECK(std::is_same_v<policy<reduce::redux, operation::bit_or>::operation, operation::bit_or>);
}

TEST_CASE("what no tag names follows from what one names") {
    using measured = gate::at_least<2, 6>;  // the gate of four floats
    const auto floats = []<class Policy>(Policy) {
        return warpagg::detail::resolved_policy<float, 4, Policy>{};
    };
    using scattered = decltype(floats(policy<>{}));
    CHECK(chooses<scattered, reduce::scatter, commit::contiguous, idle::skip, measured>);
    CHECK(std::is_same_v<scattered::operation, operation::sum>);

    // A reduction named by the caller is not gated.
    using per_lane = decltype(floats(policy{warpagg::per_lane}));
    using down = decltype(floats(policy{warpagg::shfl_down}));
    using across = decltype(floats(policy{warpagg::butterfly}));
    using across_scalar = decltype(floats(policy{warpagg::butterfly, warpagg::scalar}));
    using spread = decltype(floats(policy{warpagg::scatter}));
    CHECK(chooses<per_lane, reduce::per_lane, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<down, reduce::shfl_down, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<across, reduce::butterfly, commit::contiguous, idle::skip, gate::always>);
    CHECK(chooses<across_scalar, reduce::butterfly, commit::scalar, idle::skip, gate::always>);
    CHECK(chooses<spread, reduce::scatter, commit::contiguous, idle::skip, gate::always>);

    // A commit takes a reduction that leaves its results where it needs them.
    using scalar = decltype(floats(policy{warpagg::scalar}));
    using packed = decltype(floats(policy{warpagg::packed<4>}));
    using contiguous = decltype(floats(policy{warpagg::contiguous}));
    CHECK(chooses<scalar, reduce::shfl_down, commit::scalar, idle::skip, measured>);
    CHECK(chooses<packed, reduce::shfl_down, commit::packed<4>, idle::skip, measured>);
    CHECK(chooses<contiguous, reduce::scatter, commit::contiguous, idle::skip, measured>);

    // Zeros are added by the whole warp, so nothing is gated; a gate that is named is as named.
    using zeros = decltype(floats(policy{warpagg::add_zeros}));
    using gated = decltype(floats(policy{warpagg::at_least<5>}));
    CHECK(chooses<zeros, reduce::scatter, commit::contiguous, idle::add_zeros, gate::always>);
    CHECK(chooses<gated, reduce::scatter, commit::contiguous, idle::skip, gate::at_least<5, 5>>);
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
    CHECK(std::is_same_v<decltype(policy{warpagg::block_scope, warpagg::scatter})::scope,
                         warpagg::scope::block>);
}

TEST_CASE("a scope becomes part of the operation, and device is the default") {
    const auto operation_of = []<class Policy>(Policy) {
        return typename warpagg::detail::resolved_policy<float, 9, Policy>::operation{};
    };
    using block = decltype(operation_of(policy{warpagg::block_scope}));
    using system = decltype(operation_of(policy{warpagg::maximum, warpagg::system_scope}));
    CHECK(std::is_same_v<block, operation::scoped<operation::sum, warpagg::scope::block>>);
    CHECK(std::is_same_v<system, operation::scoped<operation::maximum, warpagg::scope::system>>);
    CHECK(std::is_same_v<decltype(operation_of(policy{warpagg::device_scope})), operation::sum>);
    CHECK(std::is_same_v<decltype(operation_of(policy<>{})), operation::sum>);
}

TEST_CASE("the default for floats, as docs/reference/policies.md has it") {
    CHECK(chooses<warpagg::default_policy<float, 1>, reduce::shfl_down, commit::scalar, idle::skip,
                  gate::always>);
    CHECK(scatters<float, 2, gate::at_least<3, 5>>);
    CHECK(scatters<float, 3, gate::at_least<2, 3>>);
    CHECK(scatters<float, 4, gate::at_least<2, 6>>);
    CHECK(scatters<float, 5, gate::always>);
    CHECK(scatters<float, 8, gate::always>);
    CHECK(scatters<float, 9, gate::at_least<8, 16>>);
    CHECK(scatters<float, 16, gate::at_least<8, 16>>);
    CHECK(scatters<float, 40, gate::at_least<8, 16>>);
}

TEST_CASE_TEMPLATE("the default for 64 bits", T, double, std::int64_t, std::uint64_t, long long) {
    CHECK(chooses<warpagg::default_policy<T, 1>, reduce::shfl_down, commit::scalar, idle::skip,
                  gate::at_least<4>>);
    CHECK(scatters<T, 2, gate::at_least<3>>);
    CHECK(scatters<T, 4, gate::at_least<3>>);
    CHECK(scatters<T, 5, gate::at_least<2>>);
    CHECK(scatters<T, 16, gate::at_least<2>>);
    CHECK(scatters<T, 17, gate::always>);
}

TEST_CASE_TEMPLATE("the default for integers of 32 bits", T, std::int32_t, std::uint32_t) {
    CHECK(
        chooses<warpagg::default_policy<T, 1>, reduce::redux, commit::contiguous, idle::skip, gate::always>);
    CHECK(
        chooses<warpagg::default_policy<T, 32>, reduce::redux, commit::contiguous, idle::skip, gate::always>);
    CHECK(scatters<T, 33, gate::always>);
}

TEST_SUITE_END();
