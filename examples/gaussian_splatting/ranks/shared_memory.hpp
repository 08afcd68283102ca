// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "communicator.hpp"
#include "transport.hpp"

namespace gs::ranks {

/// The memory that all ranks share. It is created before the ranks, in zeroed memory.
struct shared_memory {
    /// Values of one rank that the others read.
    struct slot {
        exchange_label label;
        std::size_t size;
        alignas(64) std::byte bytes[transport::most_bytes];
    };

    std::atomic<std::uint64_t> arrived;  ///< number of times that a rank has filled a slot
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

/// The transport between processes of one machine.
class shared_memory_transport final : public transport {
  public:
    shared_memory_transport(shared_memory& memory, int rank, int count)
        : memory_(memory), rank_(rank), count_(count), shown_(static_cast<std::size_t>(count)) {}

    std::span<const bytes> show(const exchange_label& label, bytes own) override;

  private:
    void wait_for_all();

    shared_memory& memory_;
    int rank_, count_;
    std::uint64_t exchanges_ = 0;  ///< number of exchanges so far
    std::vector<bytes> shown_;
};

}  // namespace gs::ranks
