// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "render/tiles/tile_order.hpp"

using gs::raster::tile_order;
using gs::raster::tile_range;

TEST_CASE("each tile comes once, and none before one of a longer class") {
    constexpr std::uint32_t tiles = 1000;
    std::mt19937 random(3);
    std::vector<tile_range> ranges;
    for (std::uint32_t begin = 0; ranges.size() < tiles; begin = ranges.back().end)
        ranges.push_back(
            {begin, begin + static_cast<std::uint32_t>((1u << random() % 14) - 1 + random() % 3)});
    std::vector<std::uint32_t> counts(tile_order::classes), members(tile_order::classes * tiles);
    const tile_order order{counts.data(), members.data(), tiles};
    gs::device::cpu device;
    device.for_each_index(tiles, gs::raster::order_tiles{ranges.data(), order});

    std::vector<bool> seen(tiles);
    int most_bits = 32;
    for (std::uint32_t i = 0; i < tiles; ++i) {
        const std::uint32_t tile = order[i];
        REQUIRE(tile < tiles);
        CHECK(!seen[tile]);
        seen[tile] = true;
        // All from 4096 on are of one class, and all below 64.
        const int bits = std::bit_width(std::clamp(ranges[tile].end - ranges[tile].begin, 63u, 4096u));
        CHECK(bits <= most_bits);
        most_bits = bits;
    }
}
