// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <numeric>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/checked.hpp>

//! [kernel]
/// Ordinary scalar code, as one lane runs it: the sum of n numbers.
template <warpagg::warp W>
WARPAGG_HD void sum(const W& w, unsigned thread, const float* numbers, unsigned n, float* total) {
    const bool active = thread < n;
    const float value[1] = {active ? numbers[thread] : 0.0f};
    warpagg::warp_reduce_atomic(w, total, value, active);
}
//! [kernel]

TEST_CASE("A kernel in every order of its lanes") {
    //! [launch]
    namespace emulator = warpagg::emulator;
    std::vector<float> numbers(100);
    std::iota(numbers.begin(), numbers.end(), 1.0f);
    const bool good = emulator::for_each_seed(20, [&](std::uint64_t seed) {
        float total = 0;
        emulator::launch({.blocks = 2, .threads = 64, .seed = seed}, [&](const emulator::checked& w) {
            sum(w, w.block_index() * w.block_size() + w.thread_index(), numbers.data(), 100, &total);
        });
        return total == 5050;
    });
    //! [launch]
    CHECK(good);
}

TEST_CASE("What a wrong kernel is told") {
    namespace emulator = warpagg::emulator;
    float totals[2] = {};
    //! [diagnosis]
    const emulator::report report = emulator::try_launch({.threads = 32}, [&](const emulator::checked& w) {
        const float value[1] = {1.0f};
        float* const mine = totals + w.lane() % 2;  // not the same in every lane
        warpagg::warp_reduce_atomic(w, mine, value, true);
    });
    // report.what: destination_not_uniform, report.lanes: 0xaaaaaaaa
    //! [diagnosis]
    CHECK(report.what == emulator::diagnosis::destination_not_uniform);
    CHECK(report.lanes == 0xaaaaaaaa);
}
