// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/serial.hpp"

#define TEST_VALUES float, double, std::int32_t
#include "reduce_atomic_commits.hpp"
