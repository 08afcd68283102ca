// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "backends/checked.hpp"
// After the backend.
#include "ordered.hpp"
