// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "shares.hpp"
#include "windows.hpp"

namespace gs::ranks {

/// The purpose of an exchange. The first four are exchanged in steps, the next two between steps, and
/// `other` are small values of both.
enum class purpose : std::size_t {
    splats,      ///< splats for the strips of others, and their numbers
    lists,       ///< the lengths of its tile lists
    gradients,   ///< the sums of its splats' gradients
    effects,     ///< the values that effects learn from a view
    gaussians,   ///< parameters and moments, for renders, new or moved Gaussians, and files
    scores,      ///< renders of several views, by which Gaussians are pruned or added
    other,       ///< losses, faults, the work of tile rows, measurements, and the agreement to go on
    connection,  ///< values by which the devices connect
    count
};
inline constexpr std::array<const char*, static_cast<std::size_t>(purpose::connection)> purpose_names{
    "splats", "lists", "gradients", "effects", "gaussians", "scores", "other"};

/// Counts the bytes that the ranks send each other. These are the bytes that the algorithm needs,
/// whatever carries them: see the members that count. All ranks count alike, for all of them together.
class traffic_counter {
  public:
    /// The exchanges for one purpose.
    struct amount {
        std::uint64_t bytes = 0;  ///< sent by all ranks together
        std::uint64_t calls = 0;  ///< number of collective calls
    };

    /// While an object exists, exchanges count for this purpose, and not for that of an outer one.
    class scope {
      public:
        scope(traffic_counter& counter, purpose now) : counter_(counter), before_(counter.now_) {
            counter.now_ = now;
        }
        scope(const scope&) = delete;
        scope& operator=(const scope&) = delete;
        ~scope() { counter_.now_ = before_; }

      private:
        traffic_counter& counter_;
        std::optional<purpose> before_;
    };

    explicit traffic_counter(int ranks) : ranks_(static_cast<std::uint64_t>(ranks)) {}

    /// Counts sums, or extremes, of arrays of this size. Each rank combines one part: it gets the part
    /// from all others, and sends them the result.
    void count_sum(std::size_t bytes) { add(purpose::other, (ranks_ - 1) * 2 * bytes); }
    /// Counts that each rank sends its share of all arrays to all others.
    void count_gather(const shares& all, std::span<const shared_array> arrays) {
        add(purpose::gaussians, (ranks_ - 1) * size_of(all, arrays));
    }
    /// Counts that each rank sends a window of all arrays to each other one.
    void count_exchange(const windows& all, std::span<const window_array> arrays) {
        std::size_t bytes = 0;
        for (const window_array& array : arrays) bytes += all.moved() * array.item_bytes;
        add(purpose::splats, bytes);
    }
    /// Counts a step, in which the ranks have these shares of the visible splats, and send `sent` places
    /// for splats to others.
    void count_step(const shares& splats, std::size_t sent) {
        sent_ += sent;
        ++steps_;
        splats_ += splats.items();
        std::size_t largest = 0;
        for (int r = 0; r < ranks(); ++r) largest = std::max(largest, splats.of(r).count());
        largest_shares_ += largest;
    }

    int ranks() const { return static_cast<int>(ranks_); }
    const amount& of(purpose p) const { return amounts_[static_cast<std::size_t>(p)]; }
    /// Returns the number of steps, and the sums over all steps of visible splats, of sent splats, and of
    /// the largest share that a rank has of the visible ones.
    /// @{
    std::uint64_t steps() const { return steps_; }
    std::uint64_t splats() const { return splats_; }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t largest_shares() const { return largest_shares_; }
    /// @}

  private:
    /// `bytes`: those that all ranks send to others.
    void add(purpose otherwise, std::size_t bytes) {
        if (ranks_ == 1) return;
        amount& sum = amounts_[static_cast<std::size_t>(now_.value_or(otherwise))];
        sum.bytes += bytes;
        ++sum.calls;
    }
    std::size_t size_of(const shares& all, std::span<const shared_array> arrays) const {
        std::size_t bytes = 0;
        for (const shared_array& array : arrays)
            for (int r = 0; r < ranks(); ++r) bytes += array.part(all, r).size();
        return bytes;
    }

    std::uint64_t ranks_;
    std::optional<purpose> now_;
    std::array<amount, static_cast<std::size_t>(purpose::count)> amounts_{};
    std::uint64_t steps_ = 0, splats_ = 0, sent_ = 0, largest_shares_ = 0;
};

}  // namespace gs::ranks
