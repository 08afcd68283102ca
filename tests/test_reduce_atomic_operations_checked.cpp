// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/checked.hpp"

#define TEST_VALUES std::uint32_t, std::int64_t
#include "reduce_atomic_operations.hpp"
