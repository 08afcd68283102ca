// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// CUDA's keywords as macros, its built-in variables, and barriers.

// Kernels use the functions of these headers without including them, in the global namespace.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "runtime_interface.hpp"

/// @{
/// Works as in CUDA, on the CPU.
#define __global__
#define __device__
#define __host__
#define __constant__
#define __managed__
#define __forceinline__ inline __attribute__((always_inline))
#define __launch_bounds__(...)
#define __align__(n) __attribute__((aligned(n)))
#define __grid_constant__
/// @}
/// A shared variable is thread-local. The emulator takes all thread-local variables of the program that a
/// kernel uses for shared memory.
#define __shared__ thread_local

/// Defines an array that kernels declare as `extern __shared__ T name[];`, in a scope around them. The
/// option `shared_bytes` of a launch determines how many of its 48 KiB a kernel may use.
#define WARPAGG_DYNAMIC_SHARED(T, name)                                                            \
    alignas(16) thread_local T name[48 * 1024 / sizeof(T)];                                        \
    [[maybe_unused]] static const bool warpagg_dynamic_shared_##name =                             \
        (::warpagg::emulator::detail::runtime::add_dynamic_shared([]() -> void* { return &name; }, \
                                                                  sizeof name),                    \
         true)

/// @{
/// Works as in CUDA. Kernels do not write these variables.
extern constinit thread_local uint3 threadIdx, blockIdx;
extern constinit thread_local dim3 blockDim, gridDim;
inline constexpr int warpSize = 32;
/// @}

/// @{
/// Works as in CUDA; the last parameter is the call site. All threads of the block call it.
inline void __syncthreads(warpagg::call_site at = warpagg::call_site::here("__syncthreads")) {
    warpagg::emulator::detail::runtime::barrier(at);
}
inline int __syncthreads_count(int p,
                               warpagg::call_site at = warpagg::call_site::here("__syncthreads_count")) {
    return static_cast<int>(warpagg::emulator::detail::runtime::count_at_barrier(p != 0, at));
}
inline int __syncthreads_or(int p, warpagg::call_site at = warpagg::call_site::here("__syncthreads_or")) {
    return warpagg::emulator::detail::runtime::count_at_barrier(p != 0, at) != 0;
}
inline int __syncthreads_and(int p, warpagg::call_site at = warpagg::call_site::here("__syncthreads_and")) {
    return warpagg::emulator::detail::runtime::count_at_barrier(p == 0, at) == 0;
}
/// @}
