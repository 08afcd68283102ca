// expect only: scatter leaves the sums spread over the lanes: scalar and packed need shfl_down or butterfly
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::packed<4>, warpagg::scatter};
