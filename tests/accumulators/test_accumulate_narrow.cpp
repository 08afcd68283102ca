// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/narrow_lanes.hpp"
// After the backend.
#include "accumulators.hpp"
