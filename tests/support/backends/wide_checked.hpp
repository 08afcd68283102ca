// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "checked_model.hpp"

namespace {

/// See lanes.hpp. A warp of 64 lanes; a kernel that breaks a rule throws.
struct backend : checked_backend<warpagg::emulator::wide_checked> {
    static constexpr const char* name = "wide checked";
};

}  // namespace
