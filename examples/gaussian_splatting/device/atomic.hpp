// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/simt/serial.hpp>

namespace gs::device {

/// What rare events are counted with, from kernels over an index: no warp is there to add up first.
WARPAGG_HD void atomic_add(unsigned long long* to, unsigned long long value) {
#if defined(__CUDA_ARCH__)
    atomicAdd(to, value);
#else
    warpagg::emulator::serial{}.atomic(
        warpagg::operation::sum{}, [to](unsigned) { return to; }, 0, value, true);
#endif
}
WARPAGG_HD void atomic_min(unsigned long long* to, unsigned long long value) {
#if defined(__CUDA_ARCH__)
    atomicMin(to, value);
#else
    warpagg::emulator::serial{}.atomic(
        warpagg::operation::minimum{}, [to](unsigned) { return to; }, 0, value, true);
#endif
}

}  // namespace gs::device
