// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The main header of the library. A warp-aggregated atomic first reduces the values of a warp's lanes
/// and then updates memory once per warp, not once per lane. Under nvcc this header includes `cuda_warp`.
/// The emulators are in warp/simd.hpp, warp/checked.hpp and warp/serial.hpp.

#include "detail/mistakes.hpp"  // directly, so that its errors name few files
#include "iterations.hpp"
#include "match_reduce_atomic.hpp"
#include "reduce_atomic.hpp"
#if defined(__CUDACC__)
#include "warp/cuda.hpp"
#endif

/// Warp-aggregated atomics.
namespace warpagg {}
