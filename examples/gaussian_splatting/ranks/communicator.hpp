// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shares.hpp"
#include "traffic.hpp"
#include "windows.hpp"

namespace gs::ranks {

/// The largest number of ranks.
inline constexpr int most_ranks = 64;

struct shared_memory;

/// Thrown by collective functions if another rank has ended early. It is no `std::exception`, so
/// that no handler of other errors stops it: this rank ends quietly, too.
struct peer_ended {};

/// The ranks: processes that train one model together.
///
/// Collective functions return when all ranks have called them. All ranks must call them in the
/// same order and with the same number of values; otherwise they throw `std::logic_error`. With one
/// rank they do nothing.
class communicator {
  public:
    /// The only rank of a training in one process.
    communicator() = default;
    communicator(shared_memory& memory, int rank, int count)
        : memory_(&memory), rank_(rank), count_(count), traffic_(count) {}
    communicator(const communicator&) = delete;
    communicator& operator=(const communicator&) = delete;

    int rank() const { return rank_; }
    int count() const { return count_; }
    /// Whether this is rank 0, the only one that prints and writes files.
    bool is_first() const { return rank_ == 0; }
    /// The bytes that the ranks exchange. Devices that have other connections count theirs here, too.
    traffic_counter& traffic() { return traffic_; }
    const traffic_counter& traffic() const { return traffic_; }

    /// @name Collective functions
    /// @{
    void barrier();
    /// Gives all ranks the sums, which are added in the order of ranks, so that all get the same
    /// bits. T: float, double, or an integer of 64 bits.
    template <class T>
    void sum(T* values, std::size_t n);
    /// Gives all ranks the smallest or the largest values. T: an integer of 64 bits.
    /// @{
    template <class T>
    void minimum(T* values, std::size_t n);
    template <class T>
    void maximum(T* values, std::size_t n);
    /// @}
    /// Gives all ranks the parts of the others. Each rank has its own part of each array.
    void gather(const shares& all, std::span<const shared_array> arrays);
    /// Sends the windows of all arrays. The window of a rank to itself is not copied.
    void exchange(const windows& all, std::span<const window_array> arrays);
    /// Returns the value of rank 0.
    double from_first(double value);
    /// Returns whether any rank passes true.
    bool any(bool flag);
    /// @}

  private:
    template <class T, class Combine>
    void reduce(std::uint32_t operation, T* values, std::size_t n, const Combine& combine);
    void gather(const shares& all, const shared_array& array);
    void exchange(const windows& all, const window_array& array);
    /// Shows some bytes to the other ranks, and calls `take(rank, theirs)` for each rank, in order.
    /// `operation` and `size` identify the whole exchange, which all ranks must agree on.
    template <class Take>
    void show(std::uint32_t operation, std::size_t size, const void* bytes, std::size_t count,
              const Take& take);

    shared_memory* memory_ = nullptr;
    int rank_ = 0, count_ = 1;
    std::uint64_t barriers_ = 0;   ///< number of barriers so far
    std::uint64_t exchanges_ = 0;  ///< number of times that values were exchanged
    traffic_counter traffic_{1};
};

}  // namespace gs::ranks
