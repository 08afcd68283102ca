// expect: use of deleted function
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(float* sums, unsigned long key) {
    const float value[1] = {1};
    warpagg::warp_match_reduce_atomic(warpagg::emulator::serial{}, sums, key, value, true);
}
