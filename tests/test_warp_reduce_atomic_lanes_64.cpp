// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/lanes.hpp"

#define TEST_VALUES std::int64_t
#include "warp_reduce_atomic.hpp"
