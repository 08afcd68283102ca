// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/serial.hpp"

#define TEST_VALUES float, double
#include "warp_reduce_atomic.hpp"
