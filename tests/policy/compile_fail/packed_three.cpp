// expect: packed<K> takes K = 2 or 4 neighbors
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::packed<3>};
