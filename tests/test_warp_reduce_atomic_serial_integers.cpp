// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/serial.hpp"

#define TEST_VALUES std::int32_t, std::uint32_t
#include "warp_reduce_atomic.hpp"
