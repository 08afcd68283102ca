// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/lanes.hpp"

#define TEST_VALUES float, std::uint64_t
#include "reduce_atomic_commits.hpp"
