// expect only: the destination is a pointer, a span or an accessor: of a container, pass its data()
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <array>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

void wrong(std::array<float, 1> sums) {
    const float value[1] = {1};
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, sums, value, true);
}
