// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../device/atomic.hpp"
#include "tile_lists.hpp"

namespace gs::raster {

/// The order in which tiles are blended: those with long lists first, so that none of them is still walked
/// when all others are done. Lists of 64 to 127, 128 to 255 and so on are of one class, and come as they may.
struct tile_order {
    static constexpr unsigned classes = 8;

    std::uint32_t* counts;   ///< of each class's tiles; zeros before `order_tiles`
    std::uint32_t* members;  ///< of each class: room for `tiles`
    std::uint32_t tiles;

    static WARPAGG_HD unsigned class_of(std::uint32_t length) {
        unsigned c = 0;
        for (std::uint32_t least = 4096; c < classes - 1 && length < least; least /= 2) ++c;
        return c;
    }
    /// The tile that comes after `place` others.
    WARPAGG_HD std::uint32_t operator[](std::uint32_t place) const {
        const std::uint32_t* in_class = members;
        unsigned before = 0, next = 0;
        WARPAGG_UNROLL
        for (unsigned c = 0; c < classes; ++c) {
            const std::uint32_t begin = next;
            next += counts[c];
            if (place >= begin && place < next) {
                before = begin;
                in_class = members + std::size_t{c} * tiles;
            }
        }
        return in_class[place - before];
    }
};

/// Finds it: one index a tile.
struct order_tiles {
    const tile_range* ranges;
    tile_order order;

    WARPAGG_HD void operator()(std::size_t tile) const {
        const unsigned c = tile_order::class_of(ranges[tile].end - ranges[tile].begin);
        const std::uint32_t place = device::atomic_add(order.counts + c, 1u);
        order.members[c * std::size_t{order.tiles} + place] = static_cast<std::uint32_t>(tile);
    }
};

}  // namespace gs::raster
