// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/lanes.hpp"

#define TEST_VALUES float
#include "sums.hpp"
