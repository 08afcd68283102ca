// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/serial.hpp"

#define TEST_VALUES float, double, std::int32_t
#include "commits.hpp"
