// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "simd.hpp"

namespace {

/// Where a test text runs; each header of this folder defines one. A test passes `launch` an object `f` with
/// `f(const W& warp)`, which exactly one warp executes, and which sees only `memory`.
/// Some backends also have `launch_block(warps, f)` for one block of up to `most_warps` warps, which
/// execute `f(const W& warp, unsigned index)`.
struct backend : simd_backend<warpagg::emulator::lanes> {
    static constexpr const char* name = "lanes";
};

}  // namespace
