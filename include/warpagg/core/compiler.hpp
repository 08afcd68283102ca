// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Macros for attributes and pragmas that differ between compilers.

#if __cplusplus < 202002L
#if defined(__CUDACC__)
#error "warpagg needs C++20: compile with -std=c++20"
#else  // GCC and clang would continue after #error, but they stop if a file is missing
#include "warpagg needs C++20: compile with -std=c++20"
#endif
#endif

#if defined(__CUDACC__)
/// Declares a function for host and device that is always inlined.
#define WARPAGG_HD __host__ __device__ __forceinline__
/// Allows a host-device template to call a device-only member. Host code must not instantiate the
/// template with such a member.
#define WARPAGG_EXEC_CHECK_DISABLE _Pragma("nv_exec_check_disable")
#elif defined(__HIPCC__)
#define WARPAGG_HD __host__ __device__ __forceinline__
#define WARPAGG_EXEC_CHECK_DISABLE
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// Not always inlined, because GCC would take minutes to instrument the inlined code.
#define WARPAGG_HD inline
#define WARPAGG_EXEC_CHECK_DISABLE
#else
#define WARPAGG_HD inline __attribute__((always_inline))
#define WARPAGG_EXEC_CHECK_DISABLE
#endif

/// Declares a large function with many callers, for host and device. Only GPUs inline it, so that code for
/// CPUs compiles sooner.
#if defined(__CUDACC__) || defined(__HIPCC__)
#define WARPAGG_HD_CALLED WARPAGG_HD
#else
#define WARPAGG_HD_CALLED inline __attribute__((noinline))
#endif

/// Unrolls a short loop, so that the arrays it indexes can stay in registers.
#if defined(__CUDA_ARCH__) || defined(__clang__)
#define WARPAGG_UNROLL _Pragma("unroll")
#elif defined(__CUDACC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WARPAGG_UNROLL  // unknown to nvcc's host compiler, slow with sanitizers
#else
#define WARPAGG_UNROLL _Pragma("GCC unroll 64")
#endif
