// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace gs::ranks {

/// Where a process is among the ranks, and among those of its machine.
struct place {
    int rank = 0, count = 1;
    int machine = 0;  ///< the first rank of the machine
    int rank_on_machine = 0, count_on_machine = 1;
};

/// Identifies an exchange. All ranks must agree on it.
struct exchange_label {
    std::uint64_t values;     ///< number of values of the whole exchange
    std::uint64_t operation;  ///< identifies the collective function and the type

    bool operator==(const exchange_label&) const = default;
};

/// Thrown by collective functions if another rank has ended early. It is no `std::exception`, so
/// that no handler of other errors stops it: this rank ends quietly, too.
struct peer_ended {};

/// Carries bytes between ranks. A `communicator` builds all collective functions on it.
class transport {
  public:
    using bytes = std::span<const std::byte>;
    /// The most bytes that a rank can show at once.
    static constexpr std::size_t most_bytes = std::size_t{1} << 20;

    transport() = default;
    transport(const transport&) = delete;
    transport& operator=(const transport&) = delete;
    virtual ~transport() = default;

    /// Shows bytes to all ranks, and returns those of each rank, in order. They are valid until the
    /// next call. Waits for all ranks. Throws `std::logic_error` if their labels differ, and
    /// `peer_ended` if one of them has ended.
    virtual std::span<const bytes> show(const exchange_label& label, bytes own) = 0;
};

inline std::logic_error disagreement(int rank, int other) {
    return std::logic_error("ranks " + std::to_string(rank) + " and " + std::to_string(other) +
                            " disagree about their next exchange");
}

/// Waits for an event, such as another rank. Call it after each failed test.
class patient_wait {
  public:
    /// Returns at once at first, because ranks arrive at about the same time. Later it leaves the
    /// processor to others. Returns whether it has done so.
    bool after_test();

  private:
    int tests_ = 0;
};

}  // namespace gs::ranks
