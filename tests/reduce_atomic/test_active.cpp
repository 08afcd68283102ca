// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The types that the argument `active` may have. policy/compile_fail/ has those that it may not.

#include <doctest/doctest.h>

#include <type_traits>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

namespace emulator = warpagg::emulator;

TEST_SUITE_BEGIN("active");

TEST_CASE("active may be a bool or an object that converts to bool") {
    const emulator::serial w;
    const float one[1] = {1};
    float sum = 0;
    const std::vector<bool> flags = {true, false};
    warpagg::warp_reduce_atomic(w, &sum, one, true);
    warpagg::warp_reduce_atomic(w, &sum, one, flags[0]);
    warpagg::warp_reduce_atomic(w, &sum, one, flags[1]);
    warpagg::warp_match_reduce_atomic(w, &sum, 0u, one, std::true_type{});
    warpagg::match(w, 0u, std::true_type{}).add(&sum, one);
    CHECK(sum == 4.0f);
    CHECK(warpagg::skip_if_warp_idle(w, std::false_type{}));
}

TEST_CASE("active may be one bool for all lanes of a SIMD model") {
    const emulator::lanes w;
    const warpagg::value_t<emulator::lanes, float> one[1] = {1.0f};
    const warpagg::value_t<emulator::lanes, unsigned> key = w.lane() % 2u;
    float sum[2] = {};
    warpagg::warp_reduce_atomic(w, sum, one, true);
    warpagg::warp_match_reduce_atomic(w, sum, key, one, true, warpagg::policy{warpagg::per_lane});
    warpagg::match(w, key, true).add(sum, one);
    CHECK(sum[0] == 64.0f);
    CHECK(sum[1] == 32.0f);
    CHECK(warpagg::skip_if_warp_idle(w, false));
}

TEST_SUITE_END();
