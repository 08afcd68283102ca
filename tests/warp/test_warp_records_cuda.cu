// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../support/backends/cuda.hpp"
#include "records.hpp"
