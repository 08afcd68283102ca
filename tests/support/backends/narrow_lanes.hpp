// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "simd.hpp"

namespace {

/// See lanes.hpp. A warp of 8 lanes.
struct backend : simd_backend<warpagg::emulator::narrow_lanes<8>> {
    static constexpr const char* name = "narrow lanes";
};

}  // namespace
