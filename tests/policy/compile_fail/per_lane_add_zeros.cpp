// expect only: per_lane has no sums, so an idle warp has no zeros to add: take skip
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::add_zeros, warpagg::per_lane};
