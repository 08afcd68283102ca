// expect only: a sum that is not native needs a
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(warpagg::accumulator<warpagg::accumulate::binned<2>>* to, const float (&v)[3]) {
    const auto base = [to](unsigned key, unsigned i) { return to + (3 * key + i); };
    warpagg::warp_match_reduce_atomic(warpagg::emulator::serial{}, base, 7u, v, true,
                                      warpagg::policy{warpagg::binned<3>});
}
