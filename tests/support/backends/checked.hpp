// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "checked_model.hpp"

namespace {

/// See lanes.hpp. A kernel that breaks a rule throws.
struct backend : checked_backend<warpagg::emulator::checked> {
    static constexpr const char* name = "checked";
};

}  // namespace
