// expect: memory has minimum, maximum, bit_and, bit_or and bit_xor for integers of 32 and 64 bits only
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/simt/serial.hpp>

void wrong(float* to, const float (&v)[3]) {
    warpagg::warp_match_reduce_atomic(warpagg::emulator::serial{}, to, 7u, v, true,
                                      warpagg::policy{warpagg::maximum});
}
