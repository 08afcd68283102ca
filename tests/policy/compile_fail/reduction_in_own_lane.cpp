// expect only: own_lane is for per_lane: a reduction leaves its sums in first_lane, every_lane or spread
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

struct reduction {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = warpagg::reduce::result_placement::own_lane;
};

const auto wrong = warpagg::policy{reduction{}};
