// expect only: per_lane commits each lane's own values: contiguous has no sums to spread over the lanes
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::contiguous, warpagg::per_lane};
