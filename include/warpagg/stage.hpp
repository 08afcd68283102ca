// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "core/tags.hpp"
#include "detail/destination.hpp"
#include "warp/concept.hpp"

namespace warpagg {

/// A record in a stage, the destination for `policy{staged}`.
template <class T>
struct staged_record {
    T* copy;  ///< component 0, in shared memory
    /// Returns the record as an accessor.
    WARPAGG_HD commit::contiguous_record<T> in_stage() const { return {copy}; }
};

/// A block's copy of a small destination in shared memory. The warps of the block add to the copy,
/// where atomics are cheap. At the end `flush` adds each value that is not zero to global memory
/// once. Use a stage for up to a few thousand values to which each block adds many times.
///
/// @snippet stage.cpp stage
///
/// Sums only. Cost per block on W lanes: ceil(size / W) row stores for `clear`; as many row loads and
/// at most `size` atomics for `flush`.
template <class T>
class stage {
  public:
    /// @param memory  `size` values in global memory
    /// @param copy    `size` values in the block's shared memory
    /// @param size    number of values
    WARPAGG_HD stage(T* memory, T* copy, unsigned size) : memory_(memory), copy_(copy), size_(size) {}

    /// Sets the copy to zero. All lanes of the block's `warps` warps call this, each warp with its
    /// index `warp` from 0. A barrier of the block must follow.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void clear(const W& w, unsigned warp, unsigned warps) const {
        for (unsigned row = warp * W::size; row < size_; row += warps * W::size)
            // mutate: stage_last_value_not_cleared
            w.store_row(copy_, static_cast<std::ptrdiff_t>(row), value_t<W, T>(T{}), w.lane() + row < size_);
    }

    /// Returns the record that begins at `memory[first]`. Precondition: the record lies in the stage.
    WARPAGG_HD staged_record<T> record(unsigned first) const { return {copy_ + first}; }

    /// Adds the copy to global memory. The warps call this as they call `clear`. A barrier of the
    /// block must precede it.
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

/// Returns the destination of a commit as an accessor. `Dst` must be a record of a stage if and only
/// if `Commit` is `staged`; otherwise it does not compile.
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
