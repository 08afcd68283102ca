// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What each policy costs, as the counting emulator tells it: exact numbers, worked out by hand or from the
/// description, not bounds.

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

namespace {

using warpagg::policy;
using warpagg::emulator::counted_lanes;
using warpagg::emulator::counters;
namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace idle = warpagg::idle;
namespace gate = warpagg::gate;

using flags = warpagg::simd_value<bool, 32>;

flags first_lanes(unsigned n) {
    flags active(false);
    for (unsigned lane = 0; lane < n; ++lane) active.set(static_cast<int>(lane), true);
    return active;
}

/// Memory whose first byte lies at the start of a 32-byte sector.
template <class T>
struct aligned_memory {
    alignas(32) T value[64] = {};
};

/// What one call costs with the first `active` lanes active and a record `offset` values past a sector's
/// start.
template <class T, int N, class Policy>
counters cost(unsigned active, unsigned offset = 0) {
    aligned_memory<T> memory;
    counters total;
    const counted_lanes w{{&total}};
    warpagg::simd_value<T, 32> v[N];
    for (auto& x : v) x = warpagg::simd_value<T, 32>(T(1));
    warpagg::warp_reduce_atomic<T, N>(w, memory.value + offset, v, first_lanes(active), Policy{});
    return total;
}

template <class T, int N>
counters default_cost(unsigned active) {
    return cost<T, N, warpagg::default_policy<T, N>>(active);
}

/// At each step a lane that holds m values moves half of them, and the odd one out besides.
unsigned scatter_shuffles(unsigned n) {
    unsigned shuffles = 0;
    for (unsigned step = 0; step < 5; ++step) {
        n = (n + 1) / 2;
        shuffles += n;
    }
    return shuffles;
}

void check_cost(const counters& c, std::uint64_t shuffles, std::uint64_t votes, std::uint64_t atomics,
                std::uint64_t commits, std::uint64_t sectors) {
    CHECK(c.shuffles == shuffles);
    CHECK(c.votes == votes);
    CHECK(c.atomics == atomics);
    CHECK(c.commits == commits);
    CHECK(c.sectors == sectors);
}

template <int N>
void check_scatter_of() {
    INFO("N = ", N);
    counters total;
    const counted_lanes w{{&total}};
    warpagg::simd_value<float, 32> v[N];
    const auto one = [](int) { return warpagg::simd_value<float, 32>(1.0f); };
    reduce::reduce_over_warp<warpagg::operation::sum>(reduce::scatter{}, w, one, v);
    CHECK(total.shuffles == scatter_shuffles(N));
}

template <int... N>
void check_scatter_of_each(std::integer_sequence<int, N...>) {
    (check_scatter_of<N>(), ...);
}

template <unsigned K>
void check_gate() {
    INFO("K = ", K);
    constexpr int n = 3;
    using gated = policy<reduce::scatter, gate::at_least<K>>;
    const counters below = cost<float, n, gated>(K - 1);
    CHECK(below.shuffles == 0);
    CHECK(below.votes == (K == 1 ? 1 : 2));  // an idle warp takes only the first vote
    CHECK(below.atomics == (K - 1) * n);
    const counters at = cost<float, n, gated>(K);
    CHECK(at.shuffles == scatter_shuffles(n));
    CHECK(at.votes == (K == 1 ? 1 : 2));  // at_least<1> needs no count
    CHECK(at.atomics == n);
}

}  // namespace

TEST_SUITE_BEGIN("counters");

TEST_CASE("nine floats, all lanes active") {
    check_cost(cost<float, 9, policy<reduce::scatter>>(32), 12, 1, 9, 1, 2);
    check_cost(cost<float, 9, policy<reduce::shfl_down>>(32), 45, 1, 9, 9, 9);
    check_cost(cost<float, 9, policy<reduce::butterfly, commit::scalar>>(32), 45, 1, 9, 9, 9);
    check_cost(cost<float, 9, policy<reduce::butterfly>>(32), 45, 1, 9, 1, 2);
    // 32 lanes at one address: one sector for each of the nine instructions.
    check_cost(cost<float, 9, policy<reduce::per_lane>>(32), 0, 0, 32 * 9, 9, 9);
}

TEST_CASE("one active lane costs a reduction no less, and per_lane next to nothing") {
    check_cost(cost<float, 9, policy<reduce::scatter>>(1), 12, 1, 9, 1, 2);
    check_cost(cost<float, 9, policy<reduce::shfl_down>>(1), 45, 1, 9, 9, 9);
    for (unsigned active = 0; active <= 32; ++active) {
        const counters c = cost<float, 9, policy<reduce::per_lane>>(active);
        CHECK(c.atomics == active * 9);
        CHECK(c.commits == (active > 0 ? 9 : 0));
        CHECK(c.shuffles == 0);
        CHECK(c.votes == 0);
    }
}

TEST_CASE("the default costs what its choice costs") {
    check_cost(default_cost<float, 1>(32), 5, 1, 1, 1, 1);
    check_cost(default_cost<float, 9>(32), 12, 2, 9, 1, 2);
    check_cost(default_cost<float, 9>(8), 12, 2, 9, 1, 2);
    check_cost(default_cost<float, 9>(7), 0, 2, 7 * 9, 9, 9);  // its gate
    check_cost(default_cost<float, 4>(1), 0, 2, 4, 4, 4);      // its gate
    check_cost(default_cost<float, 4>(2), scatter_shuffles(4), 2, 4, 1, 1);
    check_cost(default_cost<float, 17>(7), 0, 2, 7 * 17, 17, 17);
    check_cost(default_cost<float, 17>(8), scatter_shuffles(17), 2, 17, 1, 3);
}

TEST_CASE("a commit tag alone brings its reduction") {
    check_cost(cost<float, 9, policy<commit::scalar>>(32), 45, 2, 9, 9, 9);
    check_cost(cost<float, 9, policy<commit::contiguous>>(32), 12, 2, 9, 1, 2);
    // The emulators have no packed atomics.
    check_cost(cost<float, 9, policy<commit::packed<4>>>(32), 45, 2, 9, 9, 9);
}

TEST_CASE("scatter's shuffles for one to forty values") {
    CHECK(scatter_shuffles(1) == 5);
    CHECK(scatter_shuffles(3) == 2 + 1 + 1 + 1 + 1);
    CHECK(scatter_shuffles(9) == 5 + 3 + 2 + 1 + 1);
    CHECK(scatter_shuffles(16) == 8 + 4 + 2 + 1 + 1);
    CHECK(scatter_shuffles(32) == 31);
    check_scatter_of_each(std::integer_sequence<int, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 33, 40>{});
    check_cost(cost<float, 40, policy<reduce::scatter>>(32), scatter_shuffles(40), 1, 40, 2, 5);
}

TEST_CASE("a double moves in two halves") {
    check_cost(cost<double, 9, policy<reduce::scatter>>(32), 2 * 12, 1, 9, 1, 3);  // 72 bytes
    check_cost(cost<double, 9, policy<reduce::shfl_down>>(32), 2 * 45, 1, 9, 9, 9);
    check_cost(cost<std::int32_t, 9, policy<reduce::shfl_down>>(32), 45, 1, 9, 9, 9);
}

TEST_CASE("sectors by where the record starts") {
    // 36 bytes: over one border always, over two never.
    for (unsigned offset = 0; offset < 8; ++offset)
        CHECK(cost<float, 9, policy<reduce::scatter>>(32, offset).sectors == 2);
    // So too on a stride of 48 bytes, on which records start at the beginning or in the middle of a sector.
    for (unsigned record = 0; record < 4; ++record)
        CHECK(cost<float, 9, policy<reduce::scatter>>(32, 12 * record).sectors == 2);
    // 32 bytes fill one sector or parts of two.
    for (unsigned offset = 0; offset < 8; ++offset)
        CHECK(cost<float, 8, policy<reduce::scatter>>(32, offset).sectors == (offset == 0 ? 1 : 2));
    // 72 bytes, from offsets of 8: 3 sectors up to byte 24 (24 + 72 = 96), so always.
    for (unsigned offset = 0; offset < 4; ++offset)
        CHECK(cost<double, 9, policy<reduce::scatter>>(32, offset).sectors == 3);
    // 64 bytes: two sectors or parts of three.
    for (unsigned offset = 0; offset < 8; ++offset)
        CHECK(cost<float, 16, policy<reduce::scatter>>(32, offset).sectors == (offset == 0 ? 2 : 3));
}

TEST_CASE("an idle warp") {
    check_cost(cost<float, 9, policy<idle::skip>>(0), 0, 1, 0, 0, 0);
    check_cost(cost<float, 9, policy<reduce::shfl_down, idle::skip>>(0), 0, 1, 0, 0, 0);
    check_cost(cost<float, 9, policy<reduce::scatter, idle::add_zeros>>(0), 12, 0, 9, 1, 2);
    check_cost(cost<float, 9, policy<reduce::shfl_down, idle::add_zeros>>(0), 45, 0, 9, 9, 9);
    check_cost(cost<float, 9, policy<gate::at_least<2>>>(0), 0, 1, 0, 0, 0);

    counters total;
    const counted_lanes w{{&total}};
    CHECK(warpagg::skip_if_warp_idle(w, first_lanes(0)));
    CHECK_FALSE(warpagg::skip_if_warp_idle(w, first_lanes(1)));
    check_cost(total, 0, 2, 0, 0, 0);
}

TEST_CASE("assume_busy saves the vote and nothing else") {
    for (const unsigned active : {1u, 5u, 32u})
        check_cost(cost<float, 9, policy<idle::assume_busy, reduce::scatter>>(active), 12, 0, 9, 1, 2);
}

TEST_CASE("lanes with equal keys commit once") {
    float memory[32 * 3] = {};
    const auto cost_by_key = [&](const warpagg::simd_value<unsigned, 32>& key) {
        counters total;
        const counted_lanes w{{&total}};
        warpagg::simd_value<float, 32> v[3];
        for (auto& x : v) x = warpagg::simd_value<float, 32>(1.0f);
        warpagg::warp_match_reduce_atomic(w, memory, key, v, first_lanes(32));
        return total;
    };
    const auto lane = counted_lanes{}.lane();
    CHECK(cost_by_key(lane).atomics == 32 * 3);
    CHECK(cost_by_key(31u - lane).atomics == 32 * 3);
    CHECK(cost_by_key(lane & 3u).atomics == 4 * 3);
    CHECK(cost_by_key(lane / 16u).atomics == 2 * 3);
    // As many steps as the most frequent key has halvings; rising keys and a key for all need none of them.
    const auto steps = [&](const warpagg::simd_value<unsigned, 32>& key) {
        return cost_by_key(key).shuffles - cost_by_key(lane).shuffles;
    };
    CHECK(steps(lane) == 0);
    CHECK(steps(31u - lane) == 0);
    CHECK(steps(lane & 3u) == 3 * 3);
    CHECK(steps(lane / 16u) == 4 * 3);
    // One more shuffle moves the key itself.
    const counters one_key = cost_by_key(warpagg::simd_value<unsigned, 32>(5u));
    CHECK(one_key.atomics == 3);
    CHECK(steps(warpagg::simd_value<unsigned, 32>(5u)) == scatter_shuffles(3) + 1);
}

TEST_CASE("at_least<K> flips at K") {
    check_gate<1>();
    check_gate<2>();
    check_gate<8>();
    check_gate<32>();
}

TEST_CASE("the histogram of active lanes") {
    aligned_memory<float> memory;
    counters total;
    const counted_lanes w{{&total}};
    const warpagg::simd_value<float, 32> v[1] = {warpagg::simd_value<float, 32>(1.0f)};
    for (unsigned active = 0; active <= 32; ++active)
        for (unsigned time = 0; time <= active % 3; ++time)
            warpagg::warp_reduce_atomic<float, 1>(w, memory.value, v, first_lanes(active));
    warpagg::warp_reduce_atomic<float, 1>(w, memory.value, v, first_lanes(4), policy{warpagg::per_lane});
    for (unsigned active = 0; active <= 32; ++active)
        CHECK(total.active[active] == active % 3 + (active == 4 ? 2 : 1));
}

TEST_CASE("the README's example") {
    counters did;
    const counted_lanes w{{&did}};
    const auto x = warpagg::convert<float>(w.lane());
    const warpagg::simd_value<float, 32> values[2] = {x, x * x};
    float memory[2] = {};
    warpagg::warp_reduce_atomic(w, memory, values, x < 10.0f);
    CHECK(memory[0] == 45);
    CHECK(memory[1] == 285);
    CHECK(did.atomics == 2);
    CHECK(did.commits == 1);
    CHECK(did.votes == 2);  // idle test and gate
}

TEST_SUITE_END();
