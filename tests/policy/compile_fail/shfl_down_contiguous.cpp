// expect only: shfl_down and cub leave the sums in lane 0: contiguous needs butterfly or scatter
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::shfl_down, warpagg::contiguous};
