// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

using warpagg::simd_value;

TEST_CASE("warp_match_reduce_atomic") {
    warpagg::emulator::counters did;
    const warpagg::emulator::counted_lanes w{{&did}};
    //! [warp_match_reduce_atomic]
    const simd_value<unsigned, 32> bin = w.lane() / 10u;  // 0 ten times, 1 ten times, 2 ten times, 3 twice
    const simd_value<unsigned, 32> one[1] = {1u};
    unsigned histogram[4] = {100, 100, 100, 100};
    warpagg::warp_match_reduce_atomic(w, histogram, bin, one, w.lane() != 31u);
    // histogram: 110, 110, 110, 101, by 4 atomics instead of 31
    //! [warp_match_reduce_atomic]
    CHECK(histogram[0] == 110);
    CHECK(histogram[1] == 110);
    CHECK(histogram[2] == 110);
    CHECK(histogram[3] == 101);
    CHECK(did.atomics == 4);
}
