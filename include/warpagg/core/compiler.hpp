// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Macros for features that compilers spell differently.

#if __cplusplus < 202002L
#error "warpagg needs C++20: compile with -std=c++20"
#endif

#if defined(__CUDACC__)
/// Declares a function that runs on host and device and is always inlined.
#define WARPAGG_HD __host__ __device__ __forceinline__
/// Allows a host-device template to call a device-only member, as long as no host code instantiates
/// it.
#define WARPAGG_EXEC_CHECK_DISABLE _Pragma("nv_exec_check_disable")
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// Not inlined, since GCC would take minutes to instrument it.
#define WARPAGG_HD inline
#define WARPAGG_EXEC_CHECK_DISABLE
#else
#define WARPAGG_HD inline __attribute__((always_inline))
#define WARPAGG_EXEC_CHECK_DISABLE
#endif

/// Unrolls a short loop over registers; otherwise its arrays would live in memory.
#if defined(__CUDA_ARCH__) || defined(__clang__)
#define WARPAGG_UNROLL _Pragma("unroll")
#elif defined(__CUDACC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WARPAGG_UNROLL  // nvcc's host compiler does not know the pragma; sanitizers as above
#else
#define WARPAGG_UNROLL _Pragma("GCC unroll 64")
#endif
