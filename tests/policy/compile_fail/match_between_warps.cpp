// expect: between_warps goes with warp_reduce_atomic
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(warpagg::accumulator<warpagg::accumulate::exact>* to, const float (&v)[3]) {
    warpagg::warp_match_reduce_atomic(warpagg::emulator::serial{}, to, 7u, v, true,
                                      warpagg::policy{warpagg::between_warps(warpagg::exact)});
}
