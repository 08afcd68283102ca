// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/lane_math.hpp"
#include "../geometry/panorama.hpp"
#include "../geometry/splat.hpp"

namespace gs::raster {

using warpagg::mask_t;
using warpagg::value_t;

/// The tiles that the bounding box of a splat overlaps: columns [x0, x1) and rows [y0, y1). In a
/// panorama, the columns may continue behind the last one, with the first one again.
struct alignas(4) tile_box {
    std::uint16_t x0, y0, x1, y1;

    WARPAGG_HD std::uint32_t size() const { return std::uint32_t(x1 - x0) * std::uint32_t(y1 - y0); }
};

/// Returns whether the ellipse of a splat overlaps the rectangle of pixel centers from the first to
/// the last tile.
template <class Real, class Index>
WARPAGG_HD flag_of<Real> reaches_tiles(const splat<Real>& s, const Index& first_column,
                                       const Index& last_column, const Index& first_row,
                                       const Index& last_row) {
    using scalar = warpagg::scalar_t<Real>;
    const auto center = [](const Index& tile) {  // center of the tile's first pixel
        return warpagg::math::convert<scalar>(tile * Index(tile_size)) + constant<Real>(0.5);
    };
    const Real side = constant<Real>(tile_size - 1);
    return least_exponent<Real>(s.p, s.q, s.r, s.dx_per_dy, s.dy_per_dx, center(first_column) - s.x,
                                center(last_column) - s.x + side, center(first_row) - s.y,
                                center(last_row) - s.y + side) <= s.cutoff;
}

/// Returns whether the ellipse overlaps the pixel centers of the tile in this column and row.
template <class Real, class Index>
WARPAGG_HD flag_of<Real> reaches_tile(const splat<Real>& s, const Index& column, const Index& row) {
    return reaches_tiles(s, column, column, row, row);
}

/// The size of a panorama.
struct panorama_size {
    int width;
    unsigned tiles_across;
};

/// The same as `reaches_tiles` in a panorama. The answer for several columns may be true for splats
/// that reach none of them.
template <class Real, class Index>
WARPAGG_HD flag_of<Real> reaches_tiles_around(const splat<Real>& s, const Index& first_column,
                                              const Index& last_column, const Index& first_row,
                                              const Index& last_row, const panorama_size& size) {
    using scalar = warpagg::scalar_t<Real>;
    const auto offset = [](const Index& tile, const Real& from) {  // of the tile's first pixel
        return warpagg::math::convert<scalar>(tile * Index(tile_size)) + constant<Real>(0.5) - from;
    };
    const Index across(static_cast<warpagg::scalar_t<Index>>(size.tiles_across));
    const Index column = select(first_column < across, first_column, first_column - across);
    const Real side = constant<Real>(tile_size - 1), width(static_cast<scalar>(size.width));
    const Real left = offset(column, s.x);
    const auto is_one = first_column == last_column;
    const Real x0 = select(is_one, left, constant<Real>(-0.5) * width);
    const Real x1 = select(is_one, left + side, constant<Real>(0.5) * width);
    return least_exponent_around(s.p, s.q, s.r, s.dx_per_dy, s.dy_per_dx, x0, x1, offset(first_row, s.y),
                                 offset(last_row, s.y) + side, width) <= s.cutoff;
}

/// Returns whether splats reach any tile in columns [x0, x1) and rows [y0, y1). One splat per lane;
/// lanes that are not `asked` get false. Tests single tiles only in rows that the splat reaches,
/// because the box of a large splat that passes beside the image has thousands of tiles. `reaches`
/// is `reaches_tiles`, for these splats.
template <class W, class Number, class Reaches>
WARPAGG_HD mask_t<W> reaches_any_tile(const W& w, const Number& x0, const Number& x1, const Number& y0,
                                      const Number& y1, const mask_t<W>& asked, const Reaches& reaches) {
    using whole = value_t<W, int>;
    const auto index = [](const Number& n) { return warpagg::math::convert<int>(n); };
    const whole left = index(x0), right = index(x1) - whole(1), top = index(y0),
                bottom = index(y1) - whole(1);
    const mask_t<W> may = asked && left <= right && top <= bottom && reaches(left, right, top, bottom);
    mask_t<W> found = may && left == right && top == bottom, open = may && !found;
    whole column = right, row = top - whole(1);  // begins at the end of the row before the first
    while (w.any(open)) {
        const mask_t<W> is_row = column == right;
        row = select(is_row, row + whole(1), row);
        const whole first = select(is_row, left, column + whole(1)), last = select(is_row, right, first);
        const mask_t<W> reached = open && row <= bottom && reaches(first, last, row, row);
        found = found || (reached && first == last);
        column = select(is_row, select(reached, left - whole(1), right), first);
        open = open && !found && row <= bottom;
    }
    return found;
}
template <class W, class Real, class Number>
WARPAGG_HD mask_t<W> reaches_any_tile(const W& w, const splat<Real>& s, const Number& x0, const Number& x1,
                                      const Number& y0, const Number& y1, const mask_t<W>& asked) {
    return reaches_any_tile(w, x0, x1, y0, y1, asked,
                            [&](const auto&... tiles) { return reaches_tiles(s, tiles...); });
}

}  // namespace gs::raster
