// expect: memory has sums of 32 bits and more
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(short* sums) {
    const short value[1] = {1};
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, sums, value, true);
}
