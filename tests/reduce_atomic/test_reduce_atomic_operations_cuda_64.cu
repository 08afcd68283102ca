// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/cuda.hpp"

#define TEST_VALUES std::int64_t, std::uint64_t
#include "operations.hpp"
