// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/checked.hpp>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

//! [kernel]
/// Adds x, and 1 if x is positive, over those of n numbers that this warp has to look at.
template <warpagg::warp W>
WARPAGG_HD void sum_and_count(const W& w, const float* numbers, unsigned n, unsigned first, float* totals) {
    using warpagg::value_t;
    using warpagg::math::select;
    const value_t<W, unsigned> i = w.lane() + first;
    const auto active = i < n;
    const value_t<W, float> x = w.load(numbers, i, active);
    const value_t<W, float> values[2] = {x,
                                         select(x > 0.0f, value_t<W, float>(1.0f), value_t<W, float>(0.0f))};
    warpagg::warp_reduce_atomic(w, totals, values, active);
}
//! [kernel]

TEST_CASE("One kernel on every warp") {
    //! [launch]
    const std::vector<float> numbers = {1, -2, 3, -4, 5};
    float on_lanes[2] = {}, on_serial[2] = {};
    sum_and_count(warpagg::emulator::lanes{}, numbers.data(), 5, 0, on_lanes);
    for (unsigned i = 0; i < 5; ++i)
        sum_and_count(warpagg::emulator::serial{}, numbers.data(), 5, i, on_serial);
    // both: 3, 3
    //! [launch]
    CHECK(on_lanes[0] == 3);
    CHECK(on_lanes[1] == 3);
    CHECK(on_serial[0] == 3);
    CHECK(on_serial[1] == 3);
    //! [launch on the checked model]
    float on_checked[2] = {};
    warpagg::emulator::launch({.blocks = 2, .threads = 64}, [&](const warpagg::emulator::checked& w) {
        const unsigned first = w.block_index() * w.block_size() + w.thread_index() - w.lane();
        sum_and_count(w, numbers.data(), 5, first, on_checked);
    });
    // 3, 3
    //! [launch on the checked model]
    CHECK(on_checked[0] == 3);
    CHECK(on_checked[1] == 3);
}
