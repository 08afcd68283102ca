// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../device/atomic.hpp"
#include "tile_lists.hpp"

namespace gs::raster {

/// The order in which tiles are blended. Tiles with long lists come first, so that none of them is
/// still running when all others are done. The lists of a class differ in length by less than a
/// factor of two; the first class has all longer lists, and the last class all shorter ones. The
/// order within a class is unspecified.
struct tile_order {
    static constexpr unsigned classes = 8;

    std::uint32_t* counts;   ///< number of tiles per class; zero before `order_tiles`
    std::uint32_t* members;  ///< tiles of each class; `tiles` places per class
    std::uint32_t tiles;     ///< number of all tiles

    static WARPAGG_HD unsigned class_of(std::uint32_t length) {
        unsigned c = 0;
        for (std::uint32_t least = 4096; c < classes - 1 && length < least; least /= 2) ++c;
        return c;
    }
    /// Returns the tile at this place in the order.
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

/// Fills a `tile_order`. One index per tile, from `first` on.
struct order_tiles {
    const tile_range* ranges;
    tile_order order;
    std::size_t first = 0;

    WARPAGG_HD void operator()(std::size_t index) const {
        const std::size_t tile = first + index;
        const unsigned c = tile_order::class_of(ranges[tile].end - ranges[tile].begin);
        const std::uint32_t place = device::atomic_add(order.counts + c, 1u);
        order.members[c * std::size_t{order.tiles} + place] = static_cast<std::uint32_t>(tile);
    }
};

}  // namespace gs::raster
