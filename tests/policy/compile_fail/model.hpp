// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// A model of `warp` for calls that must not compile, neither on the CPU nor on a GPU.

#include <warpagg/warp/serial.hpp>

#if defined(__CUDACC__)
#define KERNEL __global__ void
using model = warpagg::cuda_warp;
#else
#define KERNEL void
using model = warpagg::emulator::serial;
#endif
