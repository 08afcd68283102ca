// expect: a sum that is not native needs a
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(warpagg::accumulator<warpagg::accumulate::f64>* to, const float (&v)[3]) {
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, to, v, true, warpagg::policy{warpagg::exact});
}
