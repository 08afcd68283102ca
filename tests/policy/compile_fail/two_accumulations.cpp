// expect only: a policy takes one accumulate tag
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(warpagg::accumulator<warpagg::accumulate::exact>* to, const float (&v)[3]) {
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, to, v, true,
                                warpagg::policy{warpagg::exact, warpagg::f64});
}
