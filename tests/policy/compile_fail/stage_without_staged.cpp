// expect: policy{staged} goes with a record of a stage, and only with that
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(const warpagg::stage<float>& block, const float (&v)[3]) {
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, block.record(0), v, true);
}
