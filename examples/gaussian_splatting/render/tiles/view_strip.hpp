// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../geometry/list_capacity.hpp"
#include "../geometry/row_range.hpp"
#include "tile_lists.hpp"
#include "tile_reach.hpp"

namespace gs::raster {

/// The tile rows of a view that one of several ranks draws. Together, the ranks own all rows.
struct view_strip {
    row_range own;
    int reach = 0;  ///< number of pixel rows beyond its own that it only renders, see `loss::reach`

    /// Returns the tile rows with tile lists, of a view with `down` tile rows.
    row_range listed(int down) const {
        return own.grown(reach / tile_size + (reach % tile_size > 0 ? 1 : 0), down);
    }
    /// Returns the rows of pixels of its own tile rows.
    row_range own_pixels(int height) const {
        return row_range{own.first * tile_size, own.last * tile_size}.within(height);
    }
};

/// Limits boxes to some tile rows. One index per Gaussian.
struct clip_boxes {
    const tile_box* boxes;
    row_range rows;
    tile_box* limited_boxes;

    WARPAGG_HD void operator()(std::size_t i) const {
        const auto limited = [this](std::uint16_t row) {
            const auto first = static_cast<std::uint16_t>(rows.first),
                       last = static_cast<std::uint16_t>(rows.last);
            return row < first ? first : row > last ? last : row;
        };
        const tile_box box = boxes[i];
        limited_boxes[i] = {box.x0, limited(box.y0), box.x1, limited(box.y1)};
    }
};

/// Writes the length of the tile lists in each own tile row, and zero for other rows. Writes after them
/// whether lists were longer than the memory for them, and their lengths are therefore unknown. One
/// index per tile row, and one more.
struct measure_rows {
    const tile_range* ranges;
    std::size_t tiles_across;
    row_range own;
    std::size_t rows;  ///< number of all tile rows
    list_capacity capacity;
    std::uint64_t* lengths;

    WARPAGG_HD void operator()(std::size_t row) const {
        std::uint64_t length = 0;
        if (row == rows)
            length = capacity.exceeded() ? 1 : 0;
        else if (static_cast<int>(row) >= own.first && static_cast<int>(row) < own.last)
            length = ranges[(row + 1) * tiles_across - 1].end - ranges[row * tiles_across].begin;
        lengths[row] = length;
    }
};

/// Moves tile lists to later places. One index per tile.
struct shift_ranges {
    tile_range* ranges;
    std::uint32_t places;

    WARPAGG_HD void operator()(std::size_t tile) const {
        ranges[tile].begin += places;
        ranges[tile].end += places;
    }
};

}  // namespace gs::raster
