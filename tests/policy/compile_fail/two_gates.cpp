// expect only: a policy takes one gate tag: always or at_least<K>
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::at_least<2>, warpagg::at_least<3>};
