// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/checked.hpp"
// After the backend.
#include "segmented_sum.hpp"
