// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/cuda.hpp"
#include "half_pairs.hpp"

#define TEST_VALUES __half2, __nv_bfloat162
#include "warp_reduce_atomic.hpp"
