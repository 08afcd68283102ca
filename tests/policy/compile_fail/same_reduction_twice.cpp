// expect only: a policy takes one reduce tag: per_lane, shfl_down, butterfly, scatter or redux
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::scatter, warpagg::scatter};
