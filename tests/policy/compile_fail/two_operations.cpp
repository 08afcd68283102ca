// expect only: a policy takes one operation: minimum, maximum, bit_and, bit_or or bit_xor
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::minimum, warpagg::scatter, warpagg::maximum};
