// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Scatter of rows: adds each row of an array to the record of a table that the row's key names, as
/// in the gradient of an embedding. `scatter_narrow_rows` is for rows of up to 16 values and
/// `scatter_wide_rows` for wider rows. With fixed-point sums the result has the same bits for any
/// order of the rows. If few keys are frequent, see `scatter_in_blocks.hpp`.

#include "detail/copied_pieces.hpp"
#include "fixed_point.hpp"
#include "match_reduce_atomic.hpp"

namespace warpagg {

/// Keys in an array, for a table of `records` records. Rows whose keys are not in [0, records) are
/// left out.
template <class Key>
struct row_keys {
    const Key* keys;      ///< one key per row
    std::size_t records;  ///< number of records of the table

    /// Returns the key of a row, and clears `inside` if the row is left out. A row that is not
    /// inside is not read.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD unsigned operator()(const W& w, std::size_t row, bool& inside) const {
        const Key key = w.load(keys + (inside ? row : 0), 0u, inside);
        // A negative key becomes a large unsigned number.
        // mutate: scatter_keys_unchecked
        inside = inside && static_cast<std::size_t>(key) < records;
        return static_cast<unsigned>(key);
    }
};

/// The conversion of values that are summands themselves; `to_fixed_point` is another one. A
/// conversion is called with a warp once, when a kernel starts.
struct unchanged {
    /// The conversion.
    struct convert {
        /// Returns the value.
        template <class T>
        WARPAGG_HD T operator()(T x) const {
            return x;
        }
    };
    /// Returns the conversion.
    template <warp W>
    WARPAGG_HD convert operator()(const W&) const {
        return {};
    }
};

/// The rows of a scatter and its table.
///
/// @tparam T        type of the rows' values
/// @tparam Sum      type of the table's values, the result of `Convert`
/// @tparam Keys     `keys(w, row, inside)`, as `row_keys`
/// @tparam Convert  `unchanged` or another conversion
/// @tparam Op       operation that combines the values of a key
template <class T, class Sum, class Keys, class Convert = unchanged, class Op = operation::sum>
struct scatter_rows {
    using value = T;       ///< see above
    using sum = Sum;       ///< see above
    using operation = Op;  ///< see above

    const T* values;       ///< `n` rows of `width` values
    std::size_t n;         ///< number of rows
    unsigned width;        ///< values per row
    Keys keys;             ///< the key of each row
    Sum* table;            ///< records of `width` values, one for each key
    Convert convert = {};  ///< how values become summands
};

namespace detail {

/// Accessors: element i from an address, and component `i` of the record of four of a key.
/// @{
template <class T>
struct element_at {
    T* address;
    WARPAGG_HD T* operator()(unsigned i) const { return address + i; }
};
template <class T>
struct component_of_four {
    T* table;
    unsigned i;
    WARPAGG_HD T* operator()(unsigned key) const { return table + (std::size_t{key} * 4 + i); }
};
/// @}

/// Transposes the 4 x 4 matrices that the rows `v` of 4 neighboring lanes form. Cost: 4 shuffles.
WARPAGG_EXEC_CHECK_DISABLE
template <class W, class V>
WARPAGG_HD void transpose_fours(const W& w, V (&v)[4]) {
    WARPAGG_UNROLL
    for (unsigned distance = 1; distance < 4; distance *= 2) {
        const bool upper = (w.lane() & distance) != 0;
        WARPAGG_UNROLL
        for (unsigned i = 0; i < 4; ++i) {
            if ((i & distance) != 0) continue;
            // mutate: scatter_transposes_own
            const V received = w.shfl_xor(upper ? v[i] : v[i + distance], distance);
            (upper ? v[i] : v[i + distance]) = received;
        }
    }
}

/// Combines transposed rows of 4 values that belong together: lane 4 q + c has component c of the rows
/// 4 q to 4 q + 3 in `v`. Bit r of `joined` tells that row r + 1 has the key of row r. The first row of
/// each key receives the result. Cost: log2 of the warp's size shuffles of one value.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class W, class V>
WARPAGG_HD void combine_joined(const W& w, V (&v)[4], lane_bits_t<W> joined) {
    const lane_bits_t<W> here = joined >> (w.lane() & ~3u);
    V head = v[3];  // of the rows of the first row's key
    WARPAGG_UNROLL
    for (int i = 2; i >= 0; --i) head = (here >> i & 1) != 0 ? Op::combine(v[i], head) : v[i];
    const unsigned rows_after_first = math::countr_zero(~here);
    WARPAGG_UNROLL
    for (unsigned distance = 4; distance < W::size; distance *= 2) {
        const V received = w.shfl_down(head, distance);
        // mutate: scatter_joins_too_far
        if (rows_after_first >= distance) head = Op::combine(head, received);
    }
    const V head_after = w.shfl_down(head, 4u);
    // mutate: scatter_run_ends_with_fours
    if ((here >> 3 & 1) != 0) v[3] = Op::combine(v[3], head_after);
    WARPAGG_UNROLL
    for (int i = 2; i >= 0; --i)
        if ((here >> i & 1) != 0) v[i] = Op::combine(v[i], v[i + 1]);
}

/// Combines rows of 4 values by key and commits each record with one instruction, in which 4 lanes
/// share the record's sector. A lane per record would touch each sector 4 times. The summands have 64
/// bits, and `convert` returns them. Records with copies are added there. Cost: rows whose keys do not
/// fall from lane to lane take fewer shuffles than others, and the same atomics.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class W, class T, class Convert, class V, class Copies>
WARPAGG_HD void add_fours(const W& w, V* table, unsigned key, T (&values)[4], const Convert& convert,
                          bool active, const Copies& copies) {
    using bits = lane_bits_t<W>;
    const bits everyone = w.ballot(active);
    const bool has_next = w.lane() + 1 < W::size;
    const unsigned next_key = w.shfl_down(key, 1u);
    // mutate: scatter_adds_what_is_left_out
    const bool is_sorted = math::popcount(everyone) == W::size && !w.any(has_next && key > next_key);
    V sums[4];
    bits leaders;
    if (is_sorted) {
        // mutate: scatter_last_row_joined
        const bits joined = w.ballot(has_next && key == next_key);
        leaders = ~(joined << 1);
        transpose_fours(w, values);  // before the conversion, which makes floats twice as large
        WARPAGG_UNROLL
        for (unsigned i = 0; i < 4; ++i) sums[i] = convert(values[i]);
        combine_joined<Op>(w, sums, joined);
    } else {
        const bits peers = math::select(active, w.match(key) & everyone, bits{0});
        WARPAGG_UNROLL
        for (unsigned i = 0; i < 4; ++i) sums[i] = convert(values[i]);
        combine_peers<Op>(w, sums, peers);
        leaders = w.ballot(active && math::countr_zero(peers) == w.lane());
        transpose_fours(w, sums);
    }
    const bits copied = copies.find(w, key, (leaders >> w.lane() & 1) != 0);
    WARPAGG_UNROLL
    for (unsigned i = 0; i < 4; ++i) {
        constexpr bits every_fourth = ~bits{0} / 15;
        if ((leaders >> i & every_fourth) == 0) continue;
        const unsigned row = (w.lane() & ~3u) + i;
        const unsigned key_of_row = w.shfl(key, row);
        copies.add(w, key_of_row, w.lane() & 3u, sums[i], (copied >> row & 1) != 0);
        w.atomic(Op{}, component_of_four<V>{table, w.lane() & 3u}, key_of_row, sums[i],
                 // mutate: copied_fours_added_twice
                 ((leaders & ~copied) >> row & 1) != 0);
    }
}

/// Combines pieces of N values by their numbers, and adds each to its copy or to the table.
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, class W, class V, int N, class Copies>
WARPAGG_HD void add_pieces(const W& w, V* table, unsigned piece, V (&sums)[N], bool active,
                           const Copies& copies) {
    using bits = lane_bits_t<W>;
    const bits peers = math::select(active, w.match(piece) & w.ballot(active), bits{0});
    combine_peers<Op>(w, sums, peers);
    const bool leads = active && math::countr_zero(peers) == w.lane();
    const bool is_copied = (copies.find(w, piece, leads) >> w.lane() & 1) != 0;
    WARPAGG_UNROLL
    for (unsigned i = 0; i < N; ++i) {
        copies.add(w, piece, i, sums[i], is_copied);
        // mutate: copied_piece_added_twice
        w.atomic(Op{}, component_by_key<V*, N>{table, i}, piece, sums[i], leads && !is_copied);
    }
}

}  // namespace detail

/// A kernel that adds narrow rows. A lane takes `Each` neighboring values, and a warp takes as many
/// whole rows as its lanes hold. Lanes with equal keys combine first. Requires a model whose value
/// type is a scalar.
///
/// Preconditions: there are fewer than 2^32 tiles; `width` is a multiple of `Each`, at most `Each`
/// times the warp's size, and the table has at most 2^32 times `Each` values. With `Each` = 4,
/// `values` and `table` are aligned to 16 bytes. Order: the sums of a key depend on the order of
/// warps, unless the operation is exact.
template <unsigned Each, class Rows>
struct scatter_narrow_rows {
    static_assert(Each == 1 || Each == 4, "a lane takes one value or four");
    Rows rows;  ///< a `scatter_rows`

    /// Returns the number of tiles, one for each warp of `lanes` lanes.
    WARPAGG_HD unsigned tiles(unsigned lanes) const {
        const unsigned in_tile = lanes / (rows.width / Each);
        return static_cast<unsigned>((rows.n + in_tile - 1) / in_tile);
    }

    /// Adds the rows of tile `index`. All lanes of the warp call this together.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        (*this)(w, index, detail::no_copies{});
    }

    /// The members that `scatter_in_blocks` uses.
    /// @{
    using sum = typename Rows::sum;
    template <warp W>
    using copies_of = detail::copied_pieces<Each, sum, typename Rows::operation>;

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void nominate(const W& w, unsigned index, const copies_of<W>& copies) const {
        place own = place_in(w, index);
        const unsigned piece = piece_at(w, own);
        copies.nominate(w, piece, index * W::size + w.lane(), own.inside);
    }
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W, class Copies>
    WARPAGG_HD void operator()(const W& w, unsigned index, const Copies& copies) const {
        using value = typename Rows::value;
        using operation = typename Rows::operation;
        constexpr bool have_copies = !std::is_same_v<Copies, detail::no_copies>;
        const auto convert = rows.convert(w);
        place own = place_in(w, index);
        value v[Each];
        if constexpr (Each == 4)
            w.load_packed(rows.values + own.first * rows.width, w.lane() * 4, v, own.inside);
        else
            v[0] = w.load(rows.values + own.first * rows.width, w.lane(), own.inside);
        const unsigned piece = piece_at(w, own);
        if constexpr (Each == 4 && sizeof(sum) == 8 && W::size % 4 == 0) {
            detail::add_fours<operation>(w, rows.table, piece, v, convert, own.inside, copies);
        } else {
            sum sums[Each];
            WARPAGG_UNROLL
            for (unsigned i = 0; i < Each; ++i) sums[i] = convert(v[i]);
            if constexpr (have_copies)
                detail::add_pieces<operation>(w, rows.table, piece, sums, own.inside, copies);
            else if constexpr (std::is_same_v<operation, warpagg::operation::sum>)
                warp_match_reduce_atomic(w, rows.table, piece, sums, own.inside);
            else
                warp_match_reduce_atomic(w, rows.table, piece, sums, own.inside, policy{operation{}});
        }
    }
    /// @}

  private:
    /// The values that a lane takes: part `part` of row `first + row`.
    struct place {
        std::size_t first;
        unsigned row, part;
        bool inside;
    };
    template <class W>
    WARPAGG_HD place place_in(const W& w, unsigned index) const {
        const unsigned parts = rows.width / Each;
        // For i up to 64, i / parts = (i inverse) / 65536.
        const unsigned inverse = 65536 / parts + 1;
        const unsigned in_tile = W::size * inverse >> 16;
        const std::size_t first = std::size_t{index} * in_tile;
        const unsigned row = w.lane() * inverse >> 16, part = w.lane() - row * parts;
        return {first, row, part, row < in_tile && first + row < rows.n};
    }
    /// Returns the number of the piece of `Each` values in the table, and clears `inside` if the row is
    /// left out.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD unsigned piece_at(const W& w, place& own) const {
        return rows.keys(w, own.first + own.row, own.inside) * (rows.width / Each) + own.part;
    }
};

/// A kernel that adds wide rows. A warp sorts the keys of as many rows as it has lanes, adds the
/// rows of each key in registers, and commits each key once. Its lanes hold neighboring values of a
/// row, `PerLane` of them at a distance of the warp's size. Requires a model whose value type is a
/// scalar. Precondition: there are fewer than 2^32 tiles.
///
/// Order: the sums of a key depend on the order of warps, unless the operation is exact.
///
/// @snippet scatter_rows.cpp scatter
template <unsigned PerLane, class Rows>
struct scatter_wide_rows {
    Rows rows;  ///< a `scatter_rows`

    /// Returns the number of tiles, one for each warp of `lanes` lanes.
    WARPAGG_HD unsigned tiles(unsigned lanes) const {
        return static_cast<unsigned>((rows.n + lanes - 1) / lanes) * stripes(lanes);
    }

    /// Adds tile `index`, a stripe of `PerLane` values per lane of some rows. All lanes of the warp
    /// call this together.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        (*this)(w, index, detail::no_copies{});
    }

    /// The members that `scatter_in_blocks` uses. Precondition: the table has at most 2^32 stripes of
    /// records.
    /// @{
    using sum = typename Rows::sum;
    template <warp W>
    using copies_of = detail::copied_pieces<W::size * PerLane, sum, typename Rows::operation>;

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void nominate(const W& w, unsigned index, const copies_of<W>& copies) const {
        const unsigned all = stripes(W::size);
        const std::size_t row = std::size_t{index / all} * W::size + w.lane();
        bool inside = row < rows.n;
        const unsigned key = rows.keys(w, row, inside);
        copies.nominate(w, key * all + index % all, static_cast<unsigned>(row), inside);
    }
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W, class Copies>
    WARPAGG_HD void operator()(const W& w, unsigned index, const Copies& copies) const {
        using operation = typename Rows::operation;
        const auto convert = rows.convert(w);
        const unsigned all = stripes(W::size), stripe = index % all;
        const std::size_t first = std::size_t{index / all} * W::size;
        const unsigned column = stripe * (W::size * PerLane);

        bool inside = w.lane() < rows.n - first;
        const unsigned key = rows.keys(w, first + w.lane(), inside);
        const unsigned count = math::popcount(w.ballot(inside));
        const std::uint64_t sorted = sort(w, inside ? std::uint64_t{key} << 8 | w.lane() : ~std::uint64_t{0});
        const auto row = static_cast<unsigned>(sorted & 0xff);
        const auto key_of_row = static_cast<unsigned>(sorted >> 8);
        const unsigned key_after = w.shfl_down(key_of_row, 1u);
        // mutate: scatter_last_row_lost
        const bool is_last = w.lane() + 1 == count || key_after != key_of_row;
        // The places in sorted order where a key has its last row.
        const lane_bits_t<W> ends = w.ballot(w.lane() < count && is_last);
        const lane_bits_t<W> copied = copies.find(w, key_of_row * all + stripe, w.lane() < count);

        sum so_far[PerLane];
        clear(so_far);
        for (unsigned begin = 0; begin < count; begin += at_once) {
            typename Rows::value v[at_once][PerLane];
            WARPAGG_UNROLL
            for (unsigned j = 0; j < at_once; ++j) {  // independent loads, which wait together
                const bool exists = begin + j < count;
                const std::size_t from = (first + w.shfl(row, exists ? begin + j : 0)) * rows.width + column;
                WARPAGG_UNROLL
                for (unsigned k = 0; k < PerLane; ++k)
                    v[j][k] = w.load(rows.values + from, lane_column(w, k),
                                     exists && column + lane_column(w, k) < rows.width);
            }
            WARPAGG_UNROLL
            for (unsigned j = 0; j < at_once; ++j) {
                if (begin + j >= count) continue;
                WARPAGG_UNROLL
                for (unsigned k = 0; k < PerLane; ++k)
                    so_far[k] = operation::combine(so_far[k], convert(v[j][k]));
                if ((ends >> (begin + j) & 1) == 0) continue;
                const unsigned record = w.shfl(key_of_row, begin + j);
                if ((copied >> (begin + j) & 1) != 0) {
                    WARPAGG_UNROLL
                    for (unsigned k = 0; k < PerLane; ++k)
                        copies.add(w, record * all + stripe, lane_column(w, k), so_far[k], true);
                } else {
                    sum* to = rows.table + (std::size_t{record} * rows.width + column);
                    WARPAGG_UNROLL
                    for (unsigned k = 0; k < PerLane; ++k)
                        w.atomic(operation{}, detail::element_at<sum>{to}, lane_column(w, k), so_far[k],
                                 column + lane_column(w, k) < rows.width);
                }
                clear(so_far);
            }
        }
    }

  private:
    static constexpr unsigned at_once = 4;  // rows whose loads are under way together

    WARPAGG_HD unsigned stripes(unsigned lanes) const {
        return (rows.width + lanes * PerLane - 1) / (lanes * PerLane);
    }
    template <class W>
    WARPAGG_HD static unsigned lane_column(const W& w, unsigned k) {
        return k * W::size + w.lane();
    }
    WARPAGG_HD static void clear(typename Rows::sum (&sums)[PerLane]) {
        WARPAGG_UNROLL
        for (auto& sum : sums) sum = Rows::operation::template identity<typename Rows::sum>();
    }
    /// Sorts one number per lane in rising order, by a bitonic network. Cost: one shuffle and one
    /// vote if the numbers rise already, and 16 shuffles otherwise on 32 lanes.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD static std::uint64_t sort(const W& w, std::uint64_t mine) {
        if (!w.any(mine > w.shfl_down(mine, 1u))) return mine;
        WARPAGG_UNROLL
        for (unsigned run = 2; run <= W::size; run *= 2) {
            WARPAGG_UNROLL
            for (unsigned distance = run / 2; distance > 0; distance /= 2) {
                const std::uint64_t other = w.shfl_xor(mine, distance);
                const bool takes_smaller = ((w.lane() & distance) == 0) == ((w.lane() & run) == 0);
                mine = (mine < other) == takes_smaller ? mine : other;
            }
        }
        return mine;
    }
};

/// The last kernel of a fixed-point scatter: adds sums to a table of floats, `table[i] += sum i`.
/// Values of the rows that are not finite are added to the table, too. Requires a model whose value
/// type is a scalar.
///
/// @snippet scatter_rows.cpp fixed point
template <class Rows>
struct add_fixed_point {
    using value = typename Rows::value;  ///< float or double
    Rows rows;                           ///< the rows of the scatter; its table has the sums
    std::size_t table_values;            ///< number of values of the table
    value* table;                        ///< the table to which sums are added

    /// Adds every `warps`-th tile, from `index` on. All lanes of the warp call this together. With
    /// two limbs, the sums of the second one follow those of the first.
    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, std::size_t index, std::size_t warps) const {
        const bool all_finite = w.load(&rows.convert.largest->not_finite, 0u, true) == 0;
        const auto format = rows.convert(w).format;
        for (std::size_t first = index * W::size; first < table_values; first += warps * W::size) {
            const bool inside = w.lane() < table_values - first;
            std::int64_t limbs[fixed_point<value>::limbs];
            WARPAGG_UNROLL
            for (int i = 0; i < fixed_point<value>::limbs; ++i)
                limbs[i] = w.load(rows.table + (first + i * table_values), w.lane(), inside);
            const double sum = format.value(limbs);
            if (!all_finite) {  // other warps may add values that are not finite
                w.atomic(operation::sum{}, detail::element_at<value>{table + first}, w.lane(),
                         static_cast<value>(sum), inside);
            } else {
                const double before = static_cast<double>(w.load(table + first, w.lane(), inside));
                w.store(table + first, w.lane(), static_cast<value>(before + sum), inside);
            }
        }
        if (!all_finite) add_not_finite(w, index, warps);
    }

  private:
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void add_not_finite(const W& w, std::size_t index, std::size_t warps) const {
        const std::size_t count = rows.n * rows.width;
        for (std::size_t first = index * W::size; first < count; first += warps * W::size) {
            const std::size_t i = first + w.lane();
            bool inside = i < count;
            const value x = w.load(rows.values + (inside ? i : 0), 0u, inside);
            inside = inside && !fixed_point<value>::is_finite(x);
            if (!w.any(inside)) continue;
            const std::size_t key = rows.keys(w, i / rows.width, inside);
            w.atomic(operation::sum{}, detail::element_at<value>{table + (key * rows.width + i % rows.width)},
                     0u, x, inside);
        }
    }
};

}  // namespace warpagg
