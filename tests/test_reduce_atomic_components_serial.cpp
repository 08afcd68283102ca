// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/serial.hpp"
#include "reduce_atomic_components.hpp"
