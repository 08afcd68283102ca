// expect: scatter leaves the sums spread over the lanes: scalar needs shfl_down or butterfly
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::scalar};
