// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/lane_math.hpp"
#include "../geometry/splat.hpp"

namespace gs::raster {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::select;

/// The tiles that the bounding box of a splat overlaps: columns [x0, x1) and rows [y0, y1).
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

/// Returns whether splats reach any tile in columns [x0, x1) and rows [y0, y1). One splat per lane;
/// lanes that are not `asked` get false. Tests single tiles only in rows that the splat reaches,
/// because the box of a large splat that passes beside the image has thousands of tiles.
template <class W, class Real, class Number>
WARPAGG_HD mask_t<W> reaches_any_tile(const W& w, const splat<Real>& s, const Number& x0, const Number& x1,
                                      const Number& y0, const Number& y1, const mask_t<W>& asked) {
    using whole = value_t<W, int>;
    const auto index = [](const Number& n) { return warpagg::math::convert<int>(n); };
    const whole left = index(x0), right = index(x1) - whole(1), top = index(y0),
                bottom = index(y1) - whole(1);
    const mask_t<W> may =
        asked && left <= right && top <= bottom && reaches_tiles(s, left, right, top, bottom);
    mask_t<W> found = may && left == right && top == bottom, open = may && !found;
    whole column = right, row = top - whole(1);  // begins at the end of the row before the first
    while (w.any(open)) {
        const mask_t<W> is_row = column == right;
        row = select(is_row, row + whole(1), row);
        const whole first = select(is_row, left, column + whole(1)), last = select(is_row, right, first);
        const mask_t<W> reached = open && row <= bottom && reaches_tiles(s, first, last, row, row);
        found = found || (reached && first == last);
        column = select(is_row, select(reached, left - whole(1), right), first);
        open = open && !found && row <= bottom;
    }
    return found;
}

}  // namespace gs::raster
