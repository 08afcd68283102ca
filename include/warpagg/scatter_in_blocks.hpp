// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Scatter of rows whose blocks keep copies of frequent records in shared memory.

#include "scatter_rows.hpp"

namespace warpagg {

/// A scatter whose blocks combine the rows of frequent keys in shared memory. Use it for 64-bit
/// integers, such as fixed-point sums, if a few keys are frequent: their atomics would wait for each
/// other in global memory. If all keys are rare, it takes a little longer than `Kernel`.
///
/// A block copies records to its shared memory: a sample of its rows decides which. It adds rows of
/// these records to the copies, and each copy to the table once. `Kernel` commits the others. The table
/// has the same bits as after `Kernel`, because operations of integers are exact.
///
/// @snippet scatter_rows.cpp in blocks
///
/// Launch no more blocks than the GPU can run at a time, so that each has many tiles. More slots hold
/// more keys, but leave shared memory for fewer blocks. Cost per block: `memory_size` sums in shared
/// memory, three barriers, and at most one atomic to the table for each value of a copy.
///
/// @tparam Kernel  a `scatter_narrow_rows` or `scatter_wide_rows` whose sums are 64-bit integers
template <class Kernel>
struct scatter_in_blocks {
    using sum = typename Kernel::sum;  ///< type of the table's values
    Kernel kernel;                     ///< adds a tile of rows
    unsigned slots;                    ///< copies per block, at least one
    unsigned blocks;                   ///< number of blocks
    unsigned warps;                    ///< warps per block

    /// Returns the number of sums that a block needs in shared memory.
    template <warp W>
    static constexpr WARPAGG_HD unsigned memory_size(unsigned slots) {
        return slots * (1 + Kernel::template copies_of<W>::values);
    }

    /// Adds the tiles of a warp. All lanes of all warps of the block call this.
    /// @param w        the warp
    /// @param block    index of the block, from 0
    /// @param warp     index of the warp in its block, from 0
    /// @param memory   `memory_size` sums in the block's shared memory, with any content
    /// @param barrier  `barrier()` waits for all warps of the block, as `__syncthreads()`
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W, class Barrier>
    WARPAGG_HD void operator()(const W& w, unsigned block, unsigned warp, sum* memory,
                               const Barrier& barrier) const {
        warp = w.shfl(warp, 0u);  // so that the compiler knows that all lanes loop alike
        const typename Kernel::template copies_of<W> copies{memory, memory + slots, slots};
        const unsigned tiles = kernel.tiles(W::size), first = block * warps + warp, step = blocks * warps;
        const unsigned own = first < tiles ? (tiles - 1 - first) / step + 1 : 0;
        // The last tiles come first: if the rows were read before, the cache holds their end.
        const auto tile = [&](unsigned i) { return tiles - 1 - first - i * step; };
        copies.clear(w, warp, warps);
        barrier();  // mutate: copies_nominated_before_cleared
        const unsigned wanted = (2 * slots / W::size) / warps + 1, samples = math::min(wanted, own);
        for (unsigned i = 0; i < samples; ++i) kernel.nominate(w, tile(own / samples * i), copies);
        barrier();  // mutate: copies_used_before_nominated
        for (unsigned i = 0; i < own; ++i) kernel(w, tile(i), copies);
        barrier();  // mutate: copies_flushed_before_complete
        copies.flush(w, kernel.rows.table, kernel.rows.width, warp, warps);
    }
};

}  // namespace warpagg
