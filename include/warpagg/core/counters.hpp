// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace warpagg::emulator {

/// The operations that an emulator counts.
struct counters {
    std::uint64_t shuffles = 0;  ///< shuffle instructions, one per 32 bits of a value
    std::uint64_t votes = 0;     ///< calls of `ballot`, `any` and `match`
    std::uint64_t atomics = 0;   ///< atomic updates of memory, one per active lane
    std::uint64_t commits = 0;   ///< warp-wide atomic instructions with at least one active lane
    std::uint64_t sectors = 0;   ///< 32-byte sectors touched by these instructions, summed over them
    /// Calls of warp_reduce_atomic and warp_match_reduce_atomic, indexed by the number of active lanes.
    std::array<std::uint64_t, 65> active{};
};

}  // namespace warpagg::emulator
