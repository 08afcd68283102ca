// expect: aggregate_traits<R> must describe all of R
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

struct particle {
    float position[3], charge;
};
template <>
struct warpagg::aggregate_traits<particle> : warpagg::aggregate_of<float, 3> {};

void wrong(particle* to, const particle& v) {
    warpagg::warp_reduce_atomic(warpagg::emulator::serial{}, to, v, true);
}
