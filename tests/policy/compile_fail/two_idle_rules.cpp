// expect only: a policy takes one idle tag: skip, assume_busy or add_zeros
// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/policy.hpp>

const auto wrong = warpagg::policy{warpagg::skip, warpagg::add_zeros};
