// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "../../device/atomic.hpp"
#include "../../ranks/communicator.hpp"
#include "../geometry/row_range.hpp"
#include "tile_lists.hpp"
#include "tile_reach.hpp"

namespace gs::raster {

/// The tile rows that each rank lists.
struct listed_tile_rows {
    unsigned ranks;
    row_range of[ranks::most_ranks];
};

/// The tile rows of a view that one of several ranks draws. Together, the ranks own all rows.
struct view_strip {
    row_range own;
    int reach = 0;  ///< number of pixel rows beyond its own that it only renders, see `loss::reach`
    std::vector<row_range> own_of_all = {};      ///< the own rows of each rank
    ranks::shares gaussians = {0, 1, 1};         ///< the Gaussians that each rank projects
    std::optional<ranks::windows> windows = {};  ///< the expected ones: see `splat_exchange::begin`
    bool is_of_step = true;  ///< whether traffic counts for a training step, or for scores

    /// Returns the tile rows with tile lists, of a view with `down` tile rows.
    row_range listed(int down) const { return listed(own, down); }
    /// Returns the tile rows with tile lists of each rank.
    listed_tile_rows listed_by_all(int down) const {
        listed_tile_rows all{static_cast<unsigned>(own_of_all.size()), {}};
        for (std::size_t rank = 0; rank < own_of_all.size(); ++rank)
            all.of[rank] = listed(own_of_all[rank], down);
        return all;
    }
    /// Returns the rows of pixels of its own tile rows.
    row_range own_pixels(int height) const {
        return row_range{own.first * tile_size, own.last * tile_size}.within(height);
    }

  private:
    row_range listed(const row_range& rows, int down) const {
        return rows.grown(reach / tile_size + (reach % tile_size > 0 ? 1 : 0), down);
    }
};

/// Returns the part of a box that lies in some tile rows.
WARPAGG_HD tile_box limited(const tile_box& box, const row_range& rows) {
    const auto in_rows = [&rows](std::uint16_t row) {
        const auto first = static_cast<std::uint16_t>(rows.first),
                   last = static_cast<std::uint16_t>(rows.last);
        return row < first ? first : row > last ? last : row;
    };
    return {box.x0, in_rows(box.y0), box.x1, in_rows(box.y1)};
}

/// The number of pixels of a whole tile that `measure_work` samples.
inline constexpr unsigned samples_per_tile = 16;

/// Adds the work of each own tile row: the numbers of splats that sampled pixels blend, and the instances in
/// its tile lists. One index per own tile.
struct measure_work {
    /// The time to list an instance, and for pixels to skip it. The unit is the time in which a sampled
    /// pixel, and those that it stands for, blend a splat.
    static constexpr unsigned work_of_instance = 4;

    const std::uint32_t* last;  ///< see `blend_forward`
    unsigned width, height, tiles_across;
    std::size_t first_tile;
    const tile_range* ranges;  ///< of all tiles
    unsigned long long* work;  ///< by tile row

    WARPAGG_HD void operator()(std::size_t i) const {
        const auto tile = static_cast<unsigned>(first_tile + i), row = tile / tiles_across;
        constexpr unsigned step = 4;
        static_assert(tile_size / step * (tile_size / step) == samples_per_tile);
        unsigned long long sum = work_of_instance * (ranges[tile].end - ranges[tile].begin);
        for (unsigned y = row * tile_size; y < (row + 1) * tile_size && y < height; y += step)
            for (unsigned k = 0, x = tile % tiles_across * tile_size; k < tile_size && x + k < width;
                 k += step)
                sum += last[std::size_t{y} * width + x + k];
        device::atomic_add(work + row, sum);
    }
};

}  // namespace gs::raster
