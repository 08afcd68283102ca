// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shares.hpp"
#include "traffic.hpp"
#include "transport.hpp"
#include "windows.hpp"

namespace gs::ranks {

/// The largest number of ranks.
inline constexpr int most_ranks = 64;

/// The ranks: processes that train one model together.
///
/// Collective functions return when all ranks have called them. All ranks must call them in the
/// same order and with the same number of values; otherwise they throw `std::logic_error`. With one
/// rank they do nothing.
class communicator {
  public:
    /// The only rank of a training in one process.
    communicator() = default;
    communicator(transport& transport, const ranks::place& place)
        : transport_(&transport), place_(place), traffic_(place.count) {}
    communicator(const communicator&) = delete;
    communicator& operator=(const communicator&) = delete;

    int rank() const { return place_.rank; }
    int count() const { return place_.count; }
    const ranks::place& place() const { return place_; }
    /// Whether this is rank 0, the only one that prints and writes files.
    bool is_first() const { return rank() == 0; }
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
    void reduce(std::uint64_t operation, T* values, std::size_t n, const Combine& combine);
    void gather(const shares& all, const shared_array& array);
    void exchange(const windows& all, const window_array& array);

    transport* transport_ = nullptr;
    ranks::place place_;
    traffic_counter traffic_{1};
};

}  // namespace gs::ranks
