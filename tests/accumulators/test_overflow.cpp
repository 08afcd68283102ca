// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Sums of integers are modulo 2^bits, signed ones too, in the warp as in memory.

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/checked.hpp>
#include <warpagg/warp/simd.hpp>

namespace {

template <class T, class... Tags>
T sum_on_lanes(warpagg::policy<Tags...> how) {
    const warpagg::emulator::lanes w;
    const warpagg::simd_value<T, 32> values[1] = {std::numeric_limits<T>::max()};
    T memory[1] = {std::numeric_limits<T>::max()};
    warpagg::warp_reduce_atomic(w, memory, values, w.lane() < 3u, how);
    return memory[0];
}

template <class T, class... Tags>
T sum_on_checked(warpagg::policy<Tags...> how) {
    T memory[1] = {std::numeric_limits<T>::max()};
    warpagg::emulator::launch({}, [&](const warpagg::emulator::checked& w) {
        const T values[1] = {std::numeric_limits<T>::max()};
        warpagg::warp_reduce_atomic(w, memory, values, w.lane() < 3, how);
    });
    return memory[0];
}

}  // namespace

TEST_SUITE_BEGIN("overflow");

TEST_CASE_TEMPLATE("four times the largest value is minus four", T, std::int32_t, std::int64_t) {
    CHECK(sum_on_lanes<T>(warpagg::policy{warpagg::shfl_down}) == -4);
    CHECK(sum_on_lanes<T>(warpagg::policy{warpagg::scatter}) == -4);
    CHECK(sum_on_lanes<T>(warpagg::policy{warpagg::per_lane}) == -4);
    CHECK(sum_on_checked<T>(warpagg::policy{warpagg::butterfly}) == -4);
    CHECK(sum_on_checked<T>(warpagg::policy{warpagg::scatter}) == -4);
}

TEST_SUITE_END();
