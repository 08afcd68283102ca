// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The one header to include: warp-aggregated atomics. A warp sums the values that its lanes hold and
/// touches memory once, instead of once per lane. Under nvcc this header also brings the warp of the GPU;
/// warp/simd.hpp, warp/checked.hpp and warp/serial.hpp bring the emulators.

#include "iterations.hpp"
#include "match_reduce_atomic.hpp"
#include "reduce_atomic.hpp"
#if defined(__CUDACC__)
#include "warp/cuda.hpp"
#endif

/// Warp-aggregated atomics.
namespace warpagg {}
