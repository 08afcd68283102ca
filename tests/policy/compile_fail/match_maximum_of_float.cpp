// expect: memory has sums of 32 bits and more, and minimum, maximum, bit_and, bit_or and bit_xor of integers
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(float* to, const float (&v)[3]) {
    warpagg::warp_match_reduce_atomic(warpagg::emulator::serial{}, to, 7u, v, true,
                                      warpagg::policy{warpagg::maximum});
}
