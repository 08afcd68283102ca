// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Emulated warps on several threads at once, as the trainer runs them: no update is lost.

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

namespace {

/// A sum that memory has no operation of its own for.
struct plus {
    template <class T>
    static T combine(T a, T b) {
        return a + b;
    }
};

constexpr unsigned thread_count = 4, rounds = 300'000;

/// What each of four addresses holds after all threads have called `add(address's index)` that often.
template <class F>
void at_once(F add) {
    std::atomic<unsigned> ready{0};
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < thread_count; ++t)
        threads.emplace_back([&] {
            ++ready;
            while (ready < thread_count) {
            }
            for (unsigned i = 0; i < rounds; ++i) add(i % 4);
        });
    for (auto& thread : threads) thread.join();
}

template <class T, class Op>
void check_sums(Op op) {
    std::array<T, 4> one_lane{}, all_lanes{};
    at_once([&](unsigned i) {
        warpagg::emulator::serial{}.atomic(
            op, [&](unsigned k) { return &one_lane[k]; }, i, T(1), true);
    });
    at_once([&](unsigned i) {
        const warpagg::emulator::lanes w;
        const warpagg::simd_value<unsigned, 32> index(i);
        const warpagg::simd_value<T, 32> ones(T(1));
        w.atomic(
            op, [&](unsigned k) { return &all_lanes[k]; }, index, ones, w.lane() < 3u);
    });
    for (unsigned i = 0; i < 4; ++i) {
        CHECK(one_lane[i] == T(thread_count * rounds / 4));
        CHECK(all_lanes[i] == T(3 * thread_count * rounds / 4));
    }
}

}  // namespace

TEST_SUITE_BEGIN("atomic memory");

TEST_CASE_TEMPLATE("no update is lost", T, std::uint32_t, float, double) {
    check_sums<T>(warpagg::operation::sum{});
    check_sums<T>(plus{});
}

TEST_SUITE_END();
