// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// `using namespace warpagg::tags` gives the names that a policy needs, and no others.

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <type_traits>
#include <warpagg/atomic.hpp>

using namespace warpagg::tags;

// Names of a program that the rest of warpagg has, too.
namespace {

struct stage {};
namespace commit {}
namespace scope {}
int at(int x) { return x; }
int fields(int x) { return x + 1; }
int match(int x) { return x + 2; }
constexpr int warp = 3, reduce = 4, gate = 5, idle = 6, operation = 7, axis = 8, aggregate = 9;

template <class... Tags>
constexpr bool has(policy<Tags...>, Tags...) {
    return true;
}

}  // namespace

TEST_SUITE_BEGIN("tags");

TEST_CASE("a policy names all tags without the rest of warpagg") {
    CHECK(std::is_same_v<decltype(policy{scatter, contiguous, skip, at_least<2>}),
                         warpagg::policy<warpagg::reduce::scatter, warpagg::commit::contiguous,
                                         warpagg::idle::skip, warpagg::gate::at_least<2>>>);
    CHECK(has(policy{shfl_down, packed<4>, assume_busy, always}, shfl_down, packed<4>, assume_busy, always));
    CHECK(has(policy{redux, bit_or, add_zeros}, redux, bit_or, add_zeros));
    CHECK(has(policy{butterfly, scalar, minimum, block_scope}, butterfly, scalar, minimum, block_scope));
    CHECK(has(policy{exact, device_scope}, exact, device_scope));
    CHECK(has(policy{between_warps(binned<3>)}, between_warps(binned<3>)));
    CHECK(has(policy{per_lane, native, maximum, system_scope}, per_lane, native, maximum, system_scope));
    CHECK(has(policy{staged}, staged));
    CHECK(has(policy{f64}, f64));
    CHECK(has(policy{compensated}, compensated));
    CHECK(has(policy{bit_and}, bit_and));
    CHECK(has(policy{bit_xor}, bit_xor));
}

TEST_CASE("names of the program stay usable beside the tags") {
    using namespace std;
    const stage unused;
    static_cast<void>(unused);
    CHECK(max(at(warp), fields(reduce)) == 5);
    CHECK(min(match(gate), idle) == 6);
    CHECK(operation + axis + aggregate == 24);
}

TEST_CASE("warpagg and warpagg::tags have the same tags") {
    CHECK(&warpagg::scatter == &warpagg::tags::scatter);
    CHECK(&warpagg::exact == &warpagg::tags::exact);
}

TEST_SUITE_END();
