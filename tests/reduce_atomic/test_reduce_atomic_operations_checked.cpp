// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/checked.hpp"

#define TEST_VALUES std::uint32_t, std::int64_t
#include "operations.hpp"
