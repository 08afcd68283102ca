// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../warp/concept.hpp"
#include "destination.hpp"

namespace warpagg::detail {

/// A block's copies of the pieces of records that its rows name often. A piece is `Values` neighboring
/// values of a record. It can have its copy in one slot only, and the piece that most lanes of a warp
/// have nominated gets the slot.
template <unsigned Values, class Sum, class Op>
struct copied_pieces {
    static_assert(std::is_integral_v<Sum> && sizeof(Sum) == 8, "copies are of 64-bit integers");
    static constexpr unsigned values = Values;  ///< values per piece

    Sum* tags;       ///< one per slot: the piece in the lower 32 bits, and 0 for an empty slot
    Sum* copies;     ///< `Values` sums per slot
    unsigned slots;  ///< number of slots

    /// Empties the slots. All lanes of the block's `warps` warps call this, each warp with its index
    /// `warp` from 0. A barrier of the block must follow, as after the calls of `nominate` and `add`.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void clear(const W& w, unsigned warp, unsigned warps) const {
        for (unsigned i = warp * W::size + w.lane(); i < slots; i += warps * W::size)
            w.store(tags, i, Sum{0}, true);  // mutate: copies_keep_old_tags
        for (unsigned i = warp * W::size + w.lane(); i < slots * Values; i += warps * W::size)
            w.store(copies, i, Op::template identity<Sum>(), true);  // mutate: copies_start_at_zero
    }
    /// Proposes the piece of each active lane. The piece that most lanes have wins its slot, and
    /// `place` decides between equals.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void nominate(const W& w, unsigned piece, unsigned place, bool active) const {
        const lane_bits_t<W> peers = w.match(piece) & w.ballot(active);
        // mutate: copies_of_rare_pieces
        const std::uint64_t priority = std::uint64_t{math::popcount(peers)} << 24 | (place & 0xffffffu);
        w.atomic(in_block<operation::maximum>{}, commit::contiguous_record<Sum>{tags}, slot_of(piece),
                 static_cast<Sum>(priority << 32 | piece), active && math::countr_zero(peers) == w.lane());
    }
    /// Returns the bits of the active lanes whose pieces have copies.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD lane_bits_t<W> find(const W& w, unsigned piece, bool active) const {
        const Sum tag = w.load(tags, slot_of(piece), active);
        // mutate: copy_in_an_empty_slot
        const bool is_taken = tag != 0;
        // mutate: copy_of_another_piece
        return w.ballot(is_taken && static_cast<std::uint32_t>(tag) == piece);
    }
    /// Adds to value `i` of the copy of a piece, in active lanes.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void add(const W& w, unsigned piece, unsigned i, Sum v, bool active) const {
        w.atomic(in_block<Op>{}, commit::contiguous_record<Sum>{copies}, slot_of(piece) * Values + i, v,
                 active);
    }
    /// Adds the copies to a table of records of `width` values. The warps call this as they call
    /// `clear`.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void flush(const W& w, Sum* table, unsigned width, unsigned warp, unsigned warps) const {
        const unsigned pieces = (width + Values - 1) / Values;
        for (unsigned first = warp * W::size; first < slots * Values; first += warps * W::size) {
            const unsigned i = first + w.lane();
            const bool exists = i < slots * Values;
            const Sum tag = w.load(tags, i / Values, exists);
            const auto piece = static_cast<std::uint32_t>(tag);
            const unsigned column = piece % pieces * Values + i % Values;
            Sum* to = table + (std::size_t{piece / pieces} * width + column);
            // mutate: copies_flushed_past_record
            const bool inside = tag != 0 && column < width;
            w.atomic(Op{}, commit::contiguous_record<Sum>{to}, 0u, w.load(copies, i, exists), inside);
        }
    }

  private:
    template <class Operation>
    using in_block = operation::scoped<Operation, scope::block>;

    WARPAGG_HD unsigned slot_of(unsigned piece) const {
        const std::uint64_t hash = piece * 0x9e3779b9u;  // the golden ratio spreads neighboring pieces
        return static_cast<unsigned>(hash * slots >> 32);
    }
};

/// Takes the place of `copied_pieces` in a kernel without copies.
struct no_copies {
    template <class W>
    WARPAGG_HD lane_bits_t<W> find(const W&, unsigned, bool) const {
        return 0;
    }
    template <class W, class Sum>
    WARPAGG_HD void add(const W&, unsigned, unsigned, Sum, bool) const {}
};

}  // namespace warpagg::detail
