// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shares.hpp"

namespace gs::ranks {

/// Describes an exchange in which each rank sends a window of items to each rank. A rank orders the
/// windows that it sends by their receivers, and those that it receives by their senders. The window
/// of a rank to itself has a place in both orders, but is not sent.
class windows {
  public:
    /// `counts`: the numbers of items of all windows: those of the first sender by receiver, those of the
    /// second one, and so on.
    windows(std::span<const std::size_t> counts, int ranks) {
        const auto n = static_cast<std::size_t>(ranks);
        for (std::size_t rank = 0; rank < n; ++rank) {
            std::vector<std::size_t> sent, received;
            for (std::size_t other = 0; other < n; ++other) {
                sent.push_back(counts[rank * n + other]);
                received.push_back(counts[other * n + rank]);
            }
            sent_.emplace_back(sent);
            received_.emplace_back(received);
        }
    }

    int ranks() const { return static_cast<int>(sent_.size()); }
    /// Returns the windows that a rank sends, or receives, as shares of all items that it sends or receives.
    /// @{
    const shares& sent_by(int rank) const { return sent_[static_cast<std::size_t>(rank)]; }
    const shares& received_by(int rank) const { return received_[static_cast<std::size_t>(rank)]; }
    /// @}
    /// Returns the number of items that ranks send to others.
    std::size_t moved() const {
        std::size_t items = 0;
        for (int rank = 0; rank < ranks(); ++rank)
            items += sent_by(rank).items() - sent_by(rank).of(rank).count();
        return items;
    }
    /// Returns whether each window has as many items as that of other windows, or more.
    bool have_places_for(const windows& others) const {
        for (int from = 0; from < ranks(); ++from)
            for (int to = 0; to < ranks(); ++to)
                if (others.sent_by(from).of(to).count() > sent_by(from).of(to).count()) return false;
        return true;
    }
    /// Returns the exchange that sends each window back to its sender.
    windows reversed() const {
        windows back = *this;
        back.sent_.swap(back.received_);
        return back;
    }

  private:
    std::vector<shares> sent_, received_;
};

/// The values of a rank's windows, as bytes: `from` has those that it sends, and `to` those that it receives.
struct window_array {
    const std::byte* from;
    std::byte* to;
    std::size_t item_bytes;

    /// Returns an array of `item_size` values per item.
    template <class T>
    static window_array of(const T* from, T* to, std::size_t item_size) {
        return {reinterpret_cast<const std::byte*>(from), reinterpret_cast<std::byte*>(to),
                item_size * sizeof(T)};
    }
    /// Returns the bytes of the window from a rank to another.
    /// @{
    std::span<const std::byte> sent(const windows& all, int from_rank, int to_rank) const {
        const share items = all.sent_by(from_rank).of(to_rank);
        return {from + items.first * item_bytes, items.count() * item_bytes};
    }
    std::span<std::byte> received(const windows& all, int from_rank, int to_rank) const {
        const share items = all.received_by(to_rank).of(from_rank);
        return {to + items.first * item_bytes, items.count() * item_bytes};
    }
    /// @}
};

}  // namespace gs::ranks
