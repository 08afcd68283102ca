// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

/// Every other lane of a warp adds its number, and twice its number, to one record.
int main() {
    const warpagg::emulator::lanes warp;
    const auto lane = warp.lane();
    const warpagg::simd_value<unsigned, 32> values[2] = {lane, lane + lane};
    unsigned record[2] = {1000, 2000};
    warpagg::warp_reduce_atomic(warp, record, values, (lane & 1u) == 0u);
    std::printf("%u %u\n", record[0], record[1]);
    return record[0] == 1000 + 240 && record[1] == 2000 + 480 ? 0 : 1;
}
