// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/checked.hpp"
#include "reduce_atomic_components.hpp"
