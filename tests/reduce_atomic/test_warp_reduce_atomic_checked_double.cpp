// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/checked.hpp"

#define TEST_VALUES double
#include "sums.hpp"
