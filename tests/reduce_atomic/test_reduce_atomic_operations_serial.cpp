// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/serial.hpp"

#define TEST_VALUES std::int32_t, std::uint64_t
#include "operations.hpp"
