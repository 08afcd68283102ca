// expect only: a stage is added to memory: staged goes with the sum
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::staged, warpagg::maximum};
