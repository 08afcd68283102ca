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

TEST_CASE("match") {
    const warpagg::emulator::lanes w;
    //! [match]
    const simd_value<unsigned, 32> vertex = w.lane() / 8u;  // 4 vertices, 8 lanes each
    const simd_value<float, 32> weight[3] = {0.5f, 0.25f, 0.125f};
    float gradient[4][3] = {};
    const auto peers = warpagg::match(w, vertex, w.lane() != 31u);
    for (unsigned attribute = 0; attribute < 3; ++attribute) {
        const simd_value<float, 32> value[1] = {weight[attribute]};
        peers.add([&](unsigned v, unsigned) { return &gradient[v][attribute]; }, value);
    }
    // gradient[0]: 4, 2, 1; gradient[3]: 3.5, 1.75, 0.875
    //! [match]
    CHECK(gradient[0][0] == 4);
    CHECK(gradient[2][1] == 2);
    CHECK(gradient[3][0] == 3.5f);
    CHECK(gradient[3][2] == 0.875f);
}
