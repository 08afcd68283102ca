// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// CUDA's warp intrinsics. Each works as in CUDA; the last parameter is the call site.

#include "runtime_interface.hpp"

/// @{
/// Works as in CUDA. The lanes of the mask that have not returned call it with the same mask.
inline void __syncwarp(unsigned mask = 0xffffffffu,
                       warpagg::call_site at = warpagg::call_site::here("__syncwarp")) {
    warpagg::emulator::detail::runtime::sync({mask, false}, at);
}
inline unsigned __ballot_sync(unsigned mask, int p,
                              warpagg::call_site at = warpagg::call_site::here("__ballot_sync")) {
    return warpagg::emulator::detail::runtime::vote({mask, false}, p != 0, at);
}
inline int __any_sync(unsigned mask, int p, warpagg::call_site at = warpagg::call_site::here("__any_sync")) {
    return warpagg::emulator::detail::runtime::vote({mask, false}, p != 0, at) != 0;
}
inline int __all_sync(unsigned mask, int p, warpagg::call_site at = warpagg::call_site::here("__all_sync")) {
    return warpagg::emulator::detail::runtime::vote({mask, false}, p == 0, at) == 0;
}
/// Works as in CUDA, but returns only some of the lanes that wait at this line, because a compiler may
/// split the lanes of a branch in any way. The seed decides which lanes these are.
inline unsigned __activemask(warpagg::call_site at = warpagg::call_site::here("__activemask")) {
    return warpagg::emulator::detail::runtime::activemask(at);
}
template <class T>
unsigned __match_any_sync(unsigned mask, T key,
                          warpagg::call_site at = warpagg::call_site::here("__match_any_sync")) {
    namespace runtime = warpagg::emulator::detail::runtime;
    return runtime::match({mask, false}, std::bit_cast<runtime::bits<sizeof(T)>>(key), at);
}

template <class T>
T __shfl_sync(unsigned mask, T v, int from, int width = 32,
              warpagg::call_site at = warpagg::call_site::here("__shfl_sync")) {
    namespace runtime = warpagg::emulator::detail::runtime;
    const unsigned w = static_cast<unsigned>(width), base = runtime::lane() & ~(w - 1);
    return runtime::exchange({mask, false}, v, base + (static_cast<unsigned>(from) & (w - 1)), at);
}
template <class T>
T __shfl_up_sync(unsigned mask, T v, unsigned distance, int width = 32,
                 warpagg::call_site at = warpagg::call_site::here("__shfl_up_sync")) {
    namespace runtime = warpagg::emulator::detail::runtime;
    const unsigned lane = runtime::lane(), in_group = lane & (static_cast<unsigned>(width) - 1);
    return runtime::exchange({mask, false}, v, distance <= in_group ? lane - distance : lane, at);
}
template <class T>
T __shfl_down_sync(unsigned mask, T v, unsigned distance, int width = 32,
                   warpagg::call_site at = warpagg::call_site::here("__shfl_down_sync")) {
    namespace runtime = warpagg::emulator::detail::runtime;
    const unsigned w = static_cast<unsigned>(width), lane = runtime::lane(), in_group = lane & (w - 1);
    return runtime::exchange({mask, false}, v, distance < w - in_group ? lane + distance : lane, at);
}
template <class T>
T __shfl_xor_sync(unsigned mask, T v, int distance, int width = 32,
                  warpagg::call_site at = warpagg::call_site::here("__shfl_xor_sync")) {
    namespace runtime = warpagg::emulator::detail::runtime;
    const unsigned lane = runtime::lane(), from = lane ^ static_cast<unsigned>(distance);
    const unsigned end = (lane & ~(static_cast<unsigned>(width) - 1)) + static_cast<unsigned>(width);
    return runtime::exchange({mask, false}, v, from < end ? from : lane, at);
}
/// @}
