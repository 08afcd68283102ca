// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "project.hpp"
#include "tile_lists.hpp"

namespace gs::raster {

/// The tiles of the Gaussians in the order of their depth: what the prefix sum runs over.
struct gather_tiles {
    const std::uint32_t* order;
    const std::uint32_t* tiles;
    std::uint32_t* sorted;

    WARPAGG_HD void operator()(std::size_t rank) const { sorted[rank] = tiles[order[rank]]; }
};

/// Marks every place as empty: its tile is past the last one.
struct clear_instances {
    std::uint32_t* tile_of;
    std::uint32_t* gaussian_of;
    std::uint32_t no_tile;

    WARPAGG_HD void operator()(std::size_t i) const {
        tile_of[i] = no_tile;
        gaussian_of[i] = 0;
    }
};

/// Writes a Gaussian's instances, one per tile that it meets: one index a rank in depth. A list that does not
/// fit is cut, and whoever reads `total` sees it.
template <class Real>
struct emit_instances {
    const std::uint32_t* order;
    const std::uint64_t* first;  ///< prefix sum of the sorted tile counts
    const splat<Real>* splats;
    const tile_box* boxes;
    unsigned tiles_across;
    std::uint64_t capacity;
    std::uint32_t* tile_of;
    std::uint32_t* gaussian_of;

    WARPAGG_HD void operator()(std::size_t rank) const {
        if (first[rank] == first[rank + 1]) return;
        const std::uint32_t gaussian = order[rank];
        std::uint64_t at = first[rank];
        for_each_tile(splats[gaussian], boxes[gaussian], tiles_across, [&](unsigned tile) {
            if (at < capacity) {
                tile_of[at] = tile;
                gaussian_of[at] = gaussian;
            }
            ++at;
        });
    }
};

/// Finds where each tile begins and ends in the list sorted by tile: one index a place. `ranges` is zero
/// before.
struct find_ranges {
    const std::uint32_t* tile_of;
    std::size_t places;
    std::uint32_t no_tile;
    tile_range* ranges;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::uint32_t tile = tile_of[i];
        if (tile == no_tile) return;
        if (i == 0 || tile_of[i - 1] != tile) ranges[tile].begin = static_cast<std::uint32_t>(i);
        if (i + 1 == places || tile_of[i + 1] != tile) ranges[tile].end = static_cast<std::uint32_t>(i + 1);
    }
};

}  // namespace gs::raster
