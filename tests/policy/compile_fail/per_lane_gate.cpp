// expect only: per_lane has no reduction for at_least<K> to stand before: take always
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::per_lane, warpagg::at_least<4>};
