// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "core/tags.hpp"
#include "detail/destination.hpp"
#include "warp/concept.hpp"

namespace warpagg {

/// A record within a stage: the destination for `policy{staged}`.
template <class T>
struct staged_record {
    T* copy;  ///< component 0, in shared memory
    /// The record as an accessor.
    WARPAGG_HD commit::contiguous_record<T> in_stage() const { return {copy}; }
};

/// A block's copy of a small destination in shared memory. Warps of the block add to the copy,
/// where atomics are cheap; at the end `flush` adds each value that is not zero to memory once. Use
/// it for up to a few thousand values to which each block adds many times.
///
/// @snippet stage.cpp stage
///
/// Sums only. Cost: size / W stores a block to clear, size loads and at most size atomics to flush.
template <class T>
class stage {
  public:
    /// @param memory  `size` values in global memory
    /// @param copy    `size` values in the block's shared memory
    /// @param size    number of values
    WARPAGG_HD stage(T* memory, T* copy, unsigned size) : memory_(memory), copy_(copy), size_(size) {}

    /// Sets the copy to zero; a barrier of the block must follow. All `warps` warps of the block
    /// call it, each with its index `warp`.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void clear(const W& w, unsigned warp, unsigned warps) const {
        for (unsigned row = warp * W::size; row < size_; row += warps * W::size)
            // mutate: stage_last_value_not_cleared
            w.store_row(copy_, static_cast<std::ptrdiff_t>(row), value_t<W, T>(T{}), w.lane() + row < size_);
    }

    /// The record that begins at `memory[first]`. Precondition: it lies within the stage.
    WARPAGG_HD staged_record<T> record(unsigned first) const { return {copy_ + first}; }

    /// Adds the copy to memory; a barrier of the block must precede it. Call it as `clear`.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void flush(const W& w, unsigned warp, unsigned warps) const {
        // mutate: stage_last_row_not_flushed
        for (unsigned row = warp * W::size; row < size_; row += warps * W::size) {
            const auto index = w.lane() + row;
            const auto sum = w.load_row(copy_, static_cast<std::ptrdiff_t>(row), index < size_);
            w.atomic(operation::sum{}, commit::contiguous_record<T>{memory_}, index, sum,
                     index < size_ && !(sum == T{}));  // mutate: stage_adds_zeros
        }
    }

  private:
    T* memory_;
    T* copy_;
    unsigned size_;
};

namespace commit {

/// The destination of `Commit`, as an accessor.
WARPAGG_EXEC_CHECK_DISABLE
template <class Commit, class Dst>
WARPAGG_HD auto record_of(Dst dst) {
    constexpr bool is_staged = requires { dst.in_stage(); };
    static_assert(is_staged == std::is_same_v<Commit, staged>,
                  "policy{staged} goes with a record of a stage, and only with that");
    if constexpr (is_staged) {
        return dst.in_stage();
    } else {
        static_assert(is_destination<Dst>,
                      "the destination is a pointer, a span or an accessor: of a container, pass its data()");
        return destination(dst);
    }
}

}  // namespace commit
}  // namespace warpagg
