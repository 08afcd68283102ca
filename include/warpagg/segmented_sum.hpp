// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Segmented sums: the sum of each run of equal keys in a sorted array, without atomics. The order of
/// additions is fixed by the order of the values, so results have the same bits from run to run
/// (`run_to_run`). Sort stably, as std::stable_sort and cub::DeviceRadixSort do. Run two kernels, on any
/// model of `warp`: first `segmented_sum_tiles`, then `segmented_sum_fixup`.

#include "warp/concept.hpp"

namespace warpagg {

/// The first kernel. One warp sums each tile of `tile_size` consecutive values.
///
/// @snippet segmented_sum.cpp segmented sum
///
/// If the values of a key may continue in another tile, their sum goes to an edge of the tile, for
/// `segmented_sum_fixup`. Error of a sum of n values of condition k on W lanes: at most
/// (n/1024 + 1024/W + log2 W + 5) u k, where u is half an ulp of one. Cost: one read of values and keys; at
/// most 2 log2(W) + 5 shuffles and one vote for each W values, and one more of each per tile.
/// Precondition: keys are below 2^32 - 1.
template <class T>
struct segmented_sum_tiles {
    static constexpr unsigned tile_size = 1024;      ///< values per warp
    static constexpr unsigned no_key = 0xffffffffu;  ///< marks an unused edge
    const unsigned* keys;                            ///< n keys, sorted
    const T* values;                                 ///< n values
    unsigned n;                                      ///< number of values
    T* sums;                                         ///< one sum per key; not written for keys without values
    unsigned* edge_keys;                             ///< key of each edge, two edges per tile
    T* edge_sums;                                    ///< sum of each edge, two edges per tile

    /// Returns the number of tiles of n values.
    static constexpr WARPAGG_HD unsigned tiles(unsigned n) {
        return n / tile_size + (n % tile_size != 0 ? 1 : 0);
    }

    /// Computes the sums of tile `index`. All lanes of the warp call this with the same index, below
    /// `tiles(n)`.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using math::select;
        using math::uniform;
        const unsigned begin = index * tile_size, end = begin + math::min(n - begin, tile_size);
        const unsigned first = key_at(w, begin);
        unsigned open = first;  // the key whose values continue; so_far is their sum
        T so_far{};
        write_edge(w, 2 * index + 1, no_key, T{});
        for (unsigned base = begin; base < end; base += W::size) {
            const mask_t<W> inside = w.lane() < end - base;
            const auto key = w.load(keys, w.lane() + base, inside);
            auto sum = w.load(values, w.lane() + base, inside);
            if (key_at(w, base) != open) {
                close(w, index, open, first, so_far);
                open = key_at(w, base);
                so_far = T{};
            }
            for (unsigned distance = 1; distance < W::size; distance *= 2) {  // a segmented scan
                const auto from = (w.lane() - distance) & (W::size - 1);
                const auto before = w.shfl(sum, from);
                const auto key_before = w.shfl(key, from);
                const mask_t<W> same = w.lane() >= distance && key_before == key;
                sum = select(same, before + sum, sum);
            }
            sum = select(key == open, sum + so_far, sum);

            const unsigned last = math::min(W::size, end - base) - 1;
            const auto key_after = w.shfl_down(key, 1u);
            const mask_t<W> ends = w.lane() < last && key_after != key;
            w.store(sums, key, sum, ends && key != first);
            const mask_t<W> ends_first = ends && key == first;
            if (w.any(ends_first))
                write_edge(w, 2 * index, first,
                           uniform(w.shfl(sum, math::countr_zero(w.ballot(ends_first)))));
            open = uniform(w.shfl(key, last));
            so_far = uniform(w.shfl(sum, last));
        }
        if (open == first)
            write_edge(w, 2 * index, open, so_far);
        else
            write_edge(w, 2 * index + 1, open, so_far);
    }

    /// @cond deprecated
    [[deprecated("use tile_size")]] static constexpr unsigned piece = tile_size;
    [[deprecated("use tiles")]] static constexpr WARPAGG_HD unsigned pieces(unsigned n) { return tiles(n); }
    /// @endcond

  private:
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD unsigned key_at(const W& w, unsigned place) const {
        using math::uniform;
        return uniform(w.shfl(w.load(keys, w.lane() * 0u + place, w.lane() == 0u), 0u));
    }
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void write_edge(const W& w, unsigned edge, unsigned key, T sum) const {
        const value_t<W, unsigned> to(edge);
        w.store(edge_keys, to, value_t<W, unsigned>(key), w.lane() == 0u);
        w.store(edge_sums, to, value_t<W, T>(sum), w.lane() == 0u);
    }
    /// Writes the sum of a key whose values end with the previous row of lanes.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void close(const W& w, unsigned index, unsigned key, unsigned first, T sum) const {
        if (key == first)
            write_edge(w, 2 * index, key, sum);
        else
            w.store(sums, value_t<W, unsigned>(key), value_t<W, T>(sum), w.lane() == 0u);
    }
};

/// The second kernel. One thread per edge, two edges per tile, adds the sums of each key that has several
/// edges. Cost: the thread of a key's first edge reads the edges up to the next key; no atomics.
template <class T>
struct segmented_sum_fixup {
    const unsigned* edge_keys;  ///< keys that `segmented_sum_tiles` wrote
    const T* edge_sums;         ///< sums that `segmented_sum_tiles` wrote
    std::size_t edges;          ///< number of edges
    T* sums;                    ///< one sum per key

    /// Writes the sum of a key if `edge` is its first edge, and does nothing otherwise.
    WARPAGG_HD void operator()(std::size_t edge) const {
        constexpr unsigned no_key = segmented_sum_tiles<T>::no_key;
        const unsigned key = edge_keys[edge];
        if (key == no_key) return;
        std::size_t before = edge;
        while (before > 0 && edge_keys[before - 1] == no_key) --before;
        if (before > 0 && edge_keys[before - 1] == key) return;  // the key's first edge adds
        T sum = edge_sums[edge];
        for (std::size_t next = edge + 1; next < edges; ++next) {
            if (edge_keys[next] == no_key) continue;
            if (edge_keys[next] != key) break;
            sum = sum + edge_sums[next];
        }
        sums[key] = sum;
    }
};

/// @cond deprecated
template <class T>
using ordered_pieces [[deprecated("use segmented_sum_tiles")]] = segmented_sum_tiles<T>;
template <class T>
using ordered_join [[deprecated("use segmented_sum_fixup")]] = segmented_sum_fixup<T>;
/// @endcond

}  // namespace warpagg
