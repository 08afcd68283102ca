// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/cuda.hpp"
#include "../support/half_pairs.hpp"

#define TEST_VALUES __half2, __nv_bfloat162
#include "sums.hpp"
