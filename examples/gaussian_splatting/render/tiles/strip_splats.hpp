// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../geometry/row_range.hpp"
#include "view_strip.hpp"

namespace gs::raster {

/// What ranks send with a splat, for its tile lists: see `project`.
struct splat_reach {
    tile_box box;
    std::uint32_t depth;
};

/// The tiles and depths of a strip's splats: those of this rank, and those that others have sent, in the
/// order of ranks.
struct strip_splats {
    std::size_t own, received;  ///< their numbers
    std::size_t before;         ///< the number of those from earlier ranks
    const tile_box* own_boxes;  ///< see `project`
    const std::uint32_t* own_depths;
    const splat_reach* from_others;

    std::size_t count() const { return own + received; }
};

/// Limits the boxes of splats to the tile rows with lists, and makes the input of the sort by depth, in the
/// order of the Gaussians. Splats without a tile get the largest depth, so that they are sorted behind all
/// others. One index per splat.
struct merge_splats {
    strip_splats splats;
    row_range listed;
    tile_box* boxes;        ///< of the own splats, and of received ones behind them
    std::uint32_t* depths;  ///< sort keys
    std::uint32_t* order;   ///< the place of each splat among `boxes`

    WARPAGG_HD void operator()(std::size_t i) const {
        const bool is_own = i >= splats.before && i - splats.before < splats.own;
        const std::size_t place = is_own ? i - splats.before : i < splats.before ? i : i - splats.own;
        const splat_reach reach = is_own ? splat_reach{splats.own_boxes[place], splats.own_depths[place]}
                                         : splats.from_others[place];
        const std::size_t at = is_own ? place : splats.own + place;
        const tile_box in_rows = limited(reach.box, listed);
        boxes[at] = in_rows;
        depths[i] = in_rows.size() == 0 ? 0xffffffffu : reach.depth;
        order[i] = static_cast<std::uint32_t>(at);
    }
};

}  // namespace gs::raster
