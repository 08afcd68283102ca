// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

using warpagg::accumulator;
using warpagg::simd_value;
namespace accumulate = warpagg::accumulate;

namespace {

const warpagg::emulator::lanes w;
const simd_value<bool, 32> active(true);

}  // namespace

TEST_CASE("exact") {
    //! [exact]
    accumulator<accumulate::exact> sums[2];  // in a kernel: in global memory, zero at first
    for (const float large : {1e30f, 1.0f, -1e30f}) {
        const simd_value<float, 32> values[2] = {large, -large};
        warpagg::warp_reduce_atomic(w, sums, values, active, warpagg::policy{warpagg::exact});
    }
    // sums[0].value(): 32, sums[1].value(): -32
    //! [exact]
    CHECK(sums[0].value() == 32);
    CHECK(sums[1].value() == -32);
}

TEST_CASE("fixed") {
    //! [fixed]
    using sum = accumulate::fixed<20>;
    const float largest = 3e6f;  // of the values, in magnitude
    std::uint32_t fault = 0;
    const sum how{&fault, sum::scale_to_fit(largest)};
    accumulator<sum> total;
    const simd_value<float, 32> values[1] = {3e6f};
    warpagg::warp_reduce_atomic(w, &total, values, active, warpagg::policy{how});
    // total.value() / how.scale: 96e6; fault: 0
    //! [fixed]
    CHECK(total.value() / how.scale == 96e6f);
    CHECK(fault == 0);
}

TEST_CASE("between warps") {
    //! [between_warps]
    accumulator<accumulate::exact> total;  // of what warps come to: in whatever order, the same bits
    for (const float large : {1e30f, 1.0f, -1e30f}) {
        const simd_value<float, 32> values[1] = {large};
        warpagg::warp_reduce_atomic(w, &total, values, active,
                                    warpagg::policy{warpagg::between_warps(warpagg::exact)});
    }
    // total.value(): 32
    //! [between_warps]
    CHECK(total.value() == 32);
}
