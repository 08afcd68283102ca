// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../device/distribute.hpp"
#include "../../scene/camera.hpp"
#include "tile_lists.hpp"
#include "tile_reach.hpp"

namespace gs::raster {

/// The splats in the order of their depth, as the items of `device::place_lists`: see
/// `device::items`. The buckets are tiles, and the candidates of a splat are the tiles of its box,
/// row by row.
template <class Real>
struct splats_by_depth {
    const std::uint32_t* order;
    const splat<Real>* splats;
    const tile_box* boxes;
    unsigned tiles_across;
    std::uint32_t first_tile = 0;  ///< that of the first bucket

    struct item {
        std::uint32_t value;  ///< index of the Gaussian
        tile_box box;
        float rows_a_tile;  ///< 1 / number of tiles in a row of the box
        unsigned tiles_across;
        std::uint32_t first_tile;
        splat<Real> shape;

        WARPAGG_HD std::uint32_t size() const { return box.size(); }
        WARPAGG_HD std::uint32_t bucket(std::uint32_t k) const {
            // k / (tiles per row), exact for k < 2^21, which is the tile count of 2^29 pixels.
            const auto down = static_cast<unsigned>((static_cast<float>(k) + 0.5f) * rows_a_tile);
            const unsigned column = box.x0 + (k - down * (box.x1 - box.x0)), row = box.y0 + down;
            // mutate: five_bits_for_the_tile
            return reaches_tile(shape, column, row) ? row * tiles_across + column - first_tile
                                                    : device::no_bucket;
        }
    };

    WARPAGG_HD item operator()(std::size_t rank) const {
        const std::uint32_t gaussian = order[rank];
        const tile_box& box = boxes[gaussian];
        return {gaussian,     box,        1.0f / static_cast<float>(box.x1 - box.x0),
                tiles_across, first_tile, splats[gaussian]};
    }
};

/// The same for a panorama.
template <class Real>
struct panorama_splats_by_depth {
    splats_by_depth<Real> splats;
    panorama_size size;

    struct item : splats_by_depth<Real>::item {
        panorama_size panorama;

        WARPAGG_HD std::uint32_t bucket(std::uint32_t k) const {
            const tile_box& b = this->box;
            const auto down = static_cast<unsigned>((static_cast<float>(k) + 0.5f) * this->rows_a_tile);
            const unsigned across = panorama.tiles_across, row = b.y0 + down;
            const unsigned place = b.x0 + (k - down * (b.x1 - b.x0));
            const unsigned column = place < across ? place : place - across;
            return reaches_tiles_around(this->shape, column, column, row, row, panorama)
                       ? row * across + column - this->first_tile
                       : device::no_bucket;
        }
    };

    WARPAGG_HD item operator()(std::size_t rank) const { return {splats(rank), size}; }
};

/// Calls f with the splats of a view as items.
template <class Real, class F>
void with_items(const camera& view, const splats_by_depth<Real>& splats, const F& f) {
    view.is_panorama ? f(panorama_splats_by_depth<Real>{splats, {view.width, splats.tiles_across}})
                     : f(splats);
}

}  // namespace gs::raster
