// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace gs::ranks {

/// The items [first, last) of a sequence.
struct share {
    std::size_t first = 0, last = 0;

    std::size_t count() const { return last - first; }
    bool operator==(const share&) const = default;
};

/// Divides a sequence into consecutive shares, one per rank. Shares may be empty.
class shares {
  public:
    /// Shares of whole blocks, apart from the last one, which differ by at most one block.
    /// Precondition: `block` and `ranks` are positive.
    shares(std::size_t items, std::size_t block, int ranks) : items_(items), block_(block) {
        const std::size_t blocks = (items + block - 1) / block, parts = static_cast<std::size_t>(ranks);
        for (std::size_t rank = 0; rank <= parts; ++rank) borders_.push_back(blocks * rank / parts);
    }
    /// Shares of whole blocks that end at these blocks, one per rank. The last one has all others.
    shares(std::size_t items, std::size_t block, std::span<const std::size_t> ends)
        : items_(items), block_(block), borders_{0} {
        borders_.insert(borders_.end(), ends.begin(), ends.end());
        borders_.back() = (items + block - 1) / block;
    }
    /// Shares with these numbers of items. A block is one item.
    explicit shares(std::span<const std::size_t> counts) {
        borders_.push_back(0);
        for (const std::size_t count : counts) borders_.push_back(borders_.back() + count);
        items_ = borders_.back();
    }

    std::size_t items() const { return items_; }
    int ranks() const { return static_cast<int>(borders_.size()) - 1; }
    share of(int rank) const { return of(rank, block_, items_); }
    /// Returns the part of an array that belongs to a rank. The array has `size` elements, and
    /// `block_size` elements per block of items. It may end early, or have a whole last block.
    share of(int rank, std::size_t block_size, std::size_t size) const {
        const auto r = static_cast<std::size_t>(rank);
        return {std::min(borders_[r] * block_size, size), std::min(borders_[r + 1] * block_size, size)};
    }
    /// Returns the parts of ranks in a piece of an array, counted from its beginning. The array has `size`
    /// elements, and `block_size` elements per block of items.
    shares within(const share& piece, std::size_t block_size, std::size_t size) const {
        std::vector<std::size_t> counts;
        for (std::size_t rank = 0; rank + 1 < borders_.size(); ++rank) {
            const share part = of(static_cast<int>(rank), block_size, size);
            const std::size_t first = std::clamp(part.first, piece.first, piece.last);
            counts.push_back(std::clamp(part.last, piece.first, piece.last) - first);
        }
        return shares(counts);
    }
    bool operator==(const shares&) const = default;

  private:
    std::size_t items_ = 0, block_ = 1;
    std::vector<std::size_t> borders_;  ///< in blocks
};

/// An array that the ranks share, as bytes: see `shares::of`.
struct shared_array {
    std::byte* data;
    std::size_t block_bytes, bytes;

    /// Returns an array of `size` values, with `block_size` values per block of items.
    template <class T>
    static shared_array of(T* values, std::size_t block_size, std::size_t size) {
        return {reinterpret_cast<std::byte*>(values), block_size * sizeof(T), size * sizeof(T)};
    }
    /// Returns the bytes of a rank.
    std::span<std::byte> part(const shares& all, int rank) const {
        const share own = all.of(rank, block_bytes, bytes);
        return {data + own.first, own.count()};
    }
};

}  // namespace gs::ranks
