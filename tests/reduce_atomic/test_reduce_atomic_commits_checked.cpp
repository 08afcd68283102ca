// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/checked.hpp"

#define TEST_VALUES float, std::uint32_t
#include "commits.hpp"
