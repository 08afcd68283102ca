// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/checked.hpp"

#define TEST_VALUES double
#include "warp_reduce_atomic.hpp"
