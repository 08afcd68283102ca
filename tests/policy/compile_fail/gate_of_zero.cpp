// expect: at_least<K> takes K > 0: without a gate, say always
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::at_least<0, 4>};
