// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/cuda.hpp"

#define TEST_VALUES std::int64_t, std::uint64_t
#include "reduce_atomic_operations.hpp"
