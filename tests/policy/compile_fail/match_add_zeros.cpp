// expect: an idle warp has no keys, so warp_match_reduce_atomic has nowhere to add zeros: take skip
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(float* sums) {
    const float value[1] = {1};
    warpagg::warp_match_reduce_atomic(warpagg::emulator::serial{}, sums, 0u, value, true,
                                      warpagg::policy{warpagg::add_zeros});
}
