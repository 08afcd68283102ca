// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "simd.hpp"

namespace {

/// See lanes.hpp. A warp of 64 lanes.
struct backend : simd_backend<warpagg::emulator::wide_lanes> {
    static constexpr const char* name = "wide lanes";
};

}  // namespace
