// expect only: at_least<K> sends an idle warp to per-lane atomics, so it never adds zeros: take skip
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::add_zeros, warpagg::at_least<2>};
