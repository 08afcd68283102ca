// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace warpagg::emulator {

/// The steps of a counting warp.
struct counters {
    std::uint64_t shuffles = 0;  ///< values moved between lanes: one instruction each for 32 bits
    std::uint64_t votes = 0;     ///< ballot, any
    std::uint64_t atomics = 0;   ///< atomic additions to memory, one per lane
    std::uint64_t commits = 0;   ///< warp-wide atomic instructions that had an active lane
    std::uint64_t sectors = 0;   ///< 32-byte sectors that each of those instructions touched
    /// Calls of warp_reduce_atomic and warp_match_reduce_atomic, by number of active lanes.
    std::array<std::uint64_t, 33> active{};
};

}  // namespace warpagg::emulator
