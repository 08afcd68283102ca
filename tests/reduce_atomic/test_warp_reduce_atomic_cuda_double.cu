// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/cuda.hpp"

#define TEST_VALUES double
#include "sums.hpp"
