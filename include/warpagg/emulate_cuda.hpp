// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Runs plain CUDA kernels on the CPU, unmodified, and diagnoses their mistakes. It declares the part of
/// CUDA C++ that kernels use: built-in variables, intrinsics, atomics, vector types, `__shared__` and
/// cooperative groups. Include it in a test, and include the kernel's source file after it. Then
/// `emulator::launch` runs the kernel. docs/how-to/test_existing_kernels.md has a complete example.
///
/// Compile the test with -fsanitize=thread, so that the compiler reports each plain memory access to the
/// emulator, and link it without that option. The CMake function `warpagg_emulate_cuda` does this and adds
/// emulate_cuda/runtime.hpp to the program. It requires POSIX, and GCC 12 or clang 14 or later.

#include "core/compiler.hpp"

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define WARPAGG_ACCESSES_ARE_REPORTED 1
#endif
#endif
#if defined(__CUDACC__)
#error "warpagg/emulate_cuda.hpp is for tests on the CPU: do not compile it with nvcc"
#elif !defined(__SANITIZE_THREAD__) && !defined(WARPAGG_ACCESSES_ARE_REPORTED)
#error \
    "warpagg/emulate_cuda.hpp needs -fsanitize=thread when it is compiled, and not when it is linked; in CMake, call warpagg_emulate_cuda(target file.cpp)"
#endif

#include "atomic.hpp"
#include "emulate_cuda/atomics.hpp"
#include "emulate_cuda/builtins.hpp"
#include "emulate_cuda/cooperative_groups.hpp"
#include "emulate_cuda/cuda_warp.hpp"
#include "emulate_cuda/device_array.hpp"
#include "emulate_cuda/launch.hpp"
#include "emulate_cuda/math.hpp"
#include "emulate_cuda/vector_types.hpp"
#include "emulate_cuda/warp_functions.hpp"
#include "warp/checked/seeds.hpp"
