// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Sums by key without any atomic, added in one order: the same bits from run to run. The values come sorted
/// by their keys, equal keys in the order that is to be kept: std::stable_sort and cub::DeviceRadixSort do
/// that. Two kernels, on any model of `warp`: `ordered_pieces`, then `ordered_join`.

#include "warp/concept.hpp"

namespace warpagg {

/// The first kernel: a warp for each `piece` places of the sorted values.
///
/// @snippet ordered.cpp ordered
///
/// Sums of keys that end in another piece than they begin wait at its edges. Error of a sum of n values of
/// condition k: (n/1024 + 42) u k with 32 lanes, u half an ulp of one. Cost: values and keys are read once;
/// 2 log2(W) + 3 shuffles and two votes for W of them.
/// Precondition: keys are below 2^32 - 1.
template <class T>
struct ordered_pieces {
    static constexpr unsigned piece = 1024;          ///< places of a warp
    static constexpr unsigned no_key = 0xffffffffu;  ///< of an edge that is none
    const unsigned* keys;                            ///< n, sorted
    const T* values;                                 ///< n
    unsigned n;                                      ///< places
    T* sums;              ///< by key; those of keys that are not there stay as they are
    unsigned* edge_keys;  ///< two a piece
    T* edge_sums;         ///< two a piece

    /// How many there are of n places.
    static constexpr WARPAGG_HD unsigned pieces(unsigned n) { return n / piece + (n % piece != 0 ? 1 : 0); }

    /// The sums of piece `index`. All lanes call this.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using math::select;
        using math::uniform;
        const unsigned begin = index * piece, end = begin + math::min(n - begin, piece);
        const unsigned first = key_at(w, begin);
        unsigned open = first;  // the key whose values go on, and what they came to so far
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
            for (unsigned distance = 1; distance < W::size; distance *= 2) {  // a scan of each key's lanes
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
    /// A key's values ended where a row of lanes did.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void close(const W& w, unsigned index, unsigned key, unsigned first, T sum) const {
        if (key == first)
            write_edge(w, 2 * index, key, sum);
        else
            w.store(sums, value_t<W, unsigned>(key), value_t<W, T>(sum), w.lane() == 0u);
    }
};

/// The second kernel: an index for each of the edges, two a piece. Adds up what one key has at several.
template <class T>
struct ordered_join {
    const unsigned* edge_keys;  ///< as `ordered_pieces` left them
    const T* edge_sums;         ///< likewise
    std::size_t edges;          ///< how many
    T* sums;                    ///< by key

    /// The sum of the key whose first edge this is, if it is one's.
    WARPAGG_HD void operator()(std::size_t edge) const {
        constexpr unsigned no_key = ordered_pieces<T>::no_key;
        const unsigned key = edge_keys[edge];
        if (key == no_key) return;
        std::size_t before = edge;
        while (before > 0 && edge_keys[before - 1] == no_key) --before;
        if (before > 0 && edge_keys[before - 1] == key) return;  // whoever has the key's first edge adds
        T sum = edge_sums[edge];
        for (std::size_t next = edge + 1; next < edges; ++next) {
            if (edge_keys[next] == no_key) continue;
            if (edge_keys[next] != key) break;
            sum = sum + edge_sums[next];
        }
        sums[key] = sum;
    }
};

}  // namespace warpagg
