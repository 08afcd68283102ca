// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/cuda.hpp"
// After the backend.
#include "ordered.hpp"
