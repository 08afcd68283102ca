// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/serial.hpp"
#include "aggregates.hpp"
