// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "communicator.hpp"

namespace gs::ranks {

/// The memory that all ranks share. It is created before the ranks, in zeroed memory.
struct shared_memory {
    static constexpr std::size_t slot_bytes = std::size_t{1} << 20;

    /// Values of one rank that the others read.
    struct slot {
        std::uint64_t values;     ///< number of values of the whole exchange
        std::uint32_t operation;  ///< identifies the collective function and the type
        alignas(64) std::byte bytes[slot_bytes];
    };

    std::atomic<std::uint64_t> arrived;  ///< number of times that a rank has entered a barrier
    std::atomic<bool> has_ended;         ///< whether a rank has ended early
    std::array<std::array<char, 1024>, most_ranks> messages;  ///< why a rank has ended
    /// Two per rank. Ranks alternate between both, so that none overwrites a slot that another one
    /// still reads.
    std::array<std::array<slot, 2>, most_ranks> slots;

    struct unmap {
        void operator()(shared_memory* memory) const;
    };
    using owner = std::unique_ptr<shared_memory, unmap>;
    /// Memory that later forks of this process share. The system provides pages when they are used.
    static owner make();
};

}  // namespace gs::ranks
