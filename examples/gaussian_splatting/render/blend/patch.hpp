// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../project/geometry.hpp"
#include "../tiles/segments.hpp"
#include "../tiles/tile_lists.hpp"

namespace gs::raster {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::fma;
using warpagg::math::select;

/// The pixels that a warp blends: blocks of one pixel per lane, one below the other. The pixels of
/// a lane lie in one column. A tile consists of `per_tile` patches.
template <class W, class Real, class Cut>
struct patch {
    static constexpr unsigned across = Cut::across, rows = Cut::rows, block = W::size / across,
                              down = block * rows;
    static_assert(W::size % across == 0 && tile_size % across == 0 && tile_size % down == 0);
    static constexpr bool panorama = Cut::panorama;
    static constexpr unsigned per_row = tile_size / across, per_tile = per_row * (tile_size / down);

    Real tile_left, tile_top;    ///< center of the tile's first pixel
    Real left, top;              ///< center of the patch's first pixel
    value_t<W, Real> x, y;       ///< the lane's first pixel, relative to the tile's first pixel
    value_t<W, unsigned> pixel;  ///< its index in a plane of the image
    unsigned step;               ///< index distance of consecutive pixels of a lane
    mask_t<W> inside[rows];      ///< whether the lane's pixels are in the image
    Real image_width;

    WARPAGG_HD patch(const W& w, unsigned tile, unsigned in_tile, unsigned tiles_across, int width,
                     int height)
        : step(block * static_cast<unsigned>(width)), image_width(static_cast<Real>(width)) {
        const unsigned tile_x = tile % tiles_across * tile_size, tile_y = tile / tiles_across * tile_size;
        const unsigned x0 = in_tile % per_row * across, y0 = in_tile / per_row * down;
        const value_t<W, unsigned> in_x = w.lane() % across + x0, in_y = w.lane() / across + y0;
        const value_t<W, unsigned> column = in_x + tile_x, row = in_y + tile_y;
        tile_left = Real(tile_x) + Real(0.5);
        tile_top = Real(tile_y) + Real(0.5);
        left = tile_left + Real(x0);
        top = tile_top + Real(y0);
        x = warpagg::math::convert<Real>(in_x);
        y = warpagg::math::convert<Real>(in_y);
        pixel = row * static_cast<unsigned>(width) + column;
        for (unsigned k = 0; k < rows; ++k)
            inside[k] =
                column < static_cast<unsigned>(width) && row + k * block < static_cast<unsigned>(height);
    }
};

/// Returns whether alpha is at least `least_alpha`.
template <class V>
WARPAGG_HD auto is_hit(const V& log2_alpha) {
    constexpr double log2_least_alpha = -7.994353436858858;  // knob: log2_least_alpha
    return log2_alpha >= V(warpagg::scalar_t<V>(log2_least_alpha));
}

/// Returns whether the mask of any row is set, for each lane.
template <class Mask, unsigned Rows>
WARPAGG_HD Mask any_of(const Mask (&masks)[Rows]) {
    Mask any = masks[0];
    for (unsigned k = 1; k < Rows; ++k) any = any || masks[k];
    return any;
}

/// Returns a bit set of the rows k in which some lane has `flag(k)`, or of all rows if `Cut` is not
/// sparse.
template <class Cut, class W, class F>
WARPAGG_HD std::uint32_t rows_with(const W& w, const F& flag) {
    std::uint32_t rows = 0;
    WARPAGG_UNROLL
    for (unsigned k = 0; k < Cut::rows; ++k) {
        const mask_t<W> flags = flag(k);
        rows |= (!Cut::sparse || w.any(flags) ? 1u : 0u) << k;
    }
    return rows;
}
/// Calls f(k) for each row k that `rows_with` has returned.
template <class Cut, class F>
WARPAGG_HD void for_each_row(std::uint32_t rows, const F& f) {
    if constexpr (Cut::sparse) {
        for (; rows != 0; rows &= rows - 1) f(warpagg::math::countr_zero(rows));
    } else {
        WARPAGG_UNROLL
        for (unsigned k = 0; k < Cut::rows; ++k) f(k);
    }
}

// knob: alpha_of_patch
/// Alpha, capped at `most_alpha`. `free`: whether the cap does not apply, so that alpha has a
/// gradient.
template <class W, class Real>
struct capped_alpha {
    value_t<W, Real> alpha;
    mask_t<W> free;

    WARPAGG_HD explicit capped_alpha(const value_t<W, Real>& log2_alpha) {
        const value_t<W, Real> most{Real(most_alpha)}, full = warpagg::math::exp2(log2_alpha);  // knob: exp2
        free = full < most;
        alpha = warpagg::math::min(full, most);
    }
};

}  // namespace gs::raster
