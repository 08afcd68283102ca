// expect only: a policy takes one commit tag: scalar, contiguous, packed<K> or staged
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::scalar, warpagg::butterfly, warpagg::contiguous};
