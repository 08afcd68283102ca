// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/warp/serial.hpp>

namespace gs::device {

/// Updates a counter of rare events in an index kernel, which cannot reduce over a warp first. The
/// memory order is relaxed. Cost: one atomic per call.
/// @{
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
/// @}

/// Adds `value` atomically, and returns the previous value. The memory order is relaxed.
WARPAGG_HD std::uint32_t atomic_add(std::uint32_t* to, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
    return atomicAdd(to, value);
#else
    return __atomic_fetch_add(to, value, __ATOMIC_RELAXED);
#endif
}

}  // namespace gs::device
