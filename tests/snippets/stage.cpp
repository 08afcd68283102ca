// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

using warpagg::simd_value;

TEST_CASE("stage") {
    const warpagg::emulator::lanes w;
    //! [stage]
    float totals[40] = {}, copy[40];  // in a kernel: global and __shared__ memory
    totals[7] = 100;
    const warpagg::stage<float> block(totals, copy, 40);
    block.clear(w, 0, 1);  // by warp 0 of 1; then __syncthreads()
    for (int step = 0; step < 10; ++step) {
        const simd_value<float, 32> values[2] = {1.0f, 2.0f};
        warpagg::warp_reduce_atomic(w, block.record(7), values, w.lane() < 8u,
                                    warpagg::policy{warpagg::staged});
    }
    block.flush(w, 0, 1);  // after __syncthreads()
    // totals[7]: 180, totals[8]: 160
    //! [stage]
    CHECK(totals[7] == 180);
    CHECK(totals[8] == 160);
    CHECK(totals[6] + totals[9] + totals[39] == 0);
}
