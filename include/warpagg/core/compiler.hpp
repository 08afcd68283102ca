// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// What compilers call the same thing by different names.

#if __cplusplus < 202002L
#error "warpagg needs C++20: compile with -std=c++20"
#endif

#if defined(__CUDACC__)
/// Before a function: it runs on host and device, and is always inlined.
#define WARPAGG_HD __host__ __device__ __forceinline__
/// A host-device template that calls a device-only member is no fault until somebody calls it from the host.
#define WARPAGG_EXEC_CHECK_DISABLE _Pragma("nv_exec_check_disable")
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC would instrument it for minutes
#define WARPAGG_HD inline
#define WARPAGG_EXEC_CHECK_DISABLE
#else
#define WARPAGG_HD inline __attribute__((always_inline))
#define WARPAGG_EXEC_CHECK_DISABLE
#endif

/// Before a short loop over registers: rolled up, its arrays would live in memory.
#if defined(__CUDA_ARCH__) || defined(__clang__)
#define WARPAGG_UNROLL _Pragma("unroll")
#elif defined(__CUDACC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WARPAGG_UNROLL  // nvcc's pass over host code, whose compiler does not know the pragma; or as above
#else
#define WARPAGG_UNROLL _Pragma("GCC unroll 64")
#endif
