// expect: redux is for integers of 32 bits: take butterfly or scatter
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(long* to, const long (&v)[3]) {
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, to, v, true, warpagg::policy{warpagg::redux});
}
