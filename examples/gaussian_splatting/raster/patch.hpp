// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "bin.hpp"
#include "geometry.hpp"
#include "splat.hpp"

namespace gs::raster {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::fma;
using warpagg::math::select;

/// The pixels that a warp owns, one a lane: 8 × 4 for 32 lanes, one for one. A tile is cut into patches.
template <class W, class Real>
struct patch {
    static constexpr unsigned across = W::size == 32 ? 8 : 1, down = W::size / across;
    static_assert(across * down == W::size);
    static constexpr unsigned per_row = tile_size / across, per_tile = per_row * (tile_size / down);

    unsigned tile;
    Real left, top;              ///< centre of the first pixel
    value_t<W, Real> x, y;       ///< centre of the lane's pixel
    value_t<W, unsigned> pixel;  ///< its place in a plane of the picture
    mask_t<W> inside;            ///< it is in the picture

    WARPAGG_HD patch(const W& w, unsigned warp_index, unsigned tiles_across, int width, int height)
        : tile(warp_index / per_tile) {
        const unsigned in_tile = warp_index % per_tile;
        const unsigned x0 = tile % tiles_across * tile_size + in_tile % per_row * across;
        const unsigned y0 = tile / tiles_across * tile_size + in_tile / per_row * down;
        const value_t<W, unsigned> column = w.lane() % across + x0, row = w.lane() / across + y0;
        left = Real(x0) + Real(0.5);
        top = Real(y0) + Real(0.5);
        x = warpagg::math::convert<Real>(column) + Real(0.5);
        y = warpagg::math::convert<Real>(row) + Real(0.5);
        pixel = row * static_cast<unsigned>(width) + column;
        inside = column < static_cast<unsigned>(width) && row < static_cast<unsigned>(height);
    }

    /// Which of W::size instances from `base` on reach the patch: bit i stands for instance base + i. Each
    /// lane asks for one.
    WARPAGG_HD std::uint32_t reached_by(const W& w, const splat<Real>* splats,
                                        const std::uint32_t* gaussian_of, unsigned base, unsigned end) const {
        using real = value_t<W, Real>;
        constexpr unsigned stride = sizeof(splat<Real>) / sizeof(Real);
        const auto place = w.lane() + base;
        const mask_t<W> valid = place < end;
        const value_t<W, unsigned> first = w.load(gaussian_of, place, valid) * stride;
        const auto field = [&](unsigned i) {
            return w.load(reinterpret_cast<const Real*>(splats), first + i, valid);
        };
        const real x0 = left - field(0), y0 = top - field(1), reach = field(2);
        const real least = least_exponent<real>(field(4), field(5), field(6), field(11), field(7), x0,
                                                x0 + Real(across - 1), y0, y0 + Real(down - 1));
        return w.ballot(valid && least <= reach);
    }
};

/// What one pixel sees of a splat.
template <class W, class Real>
struct coverage {
    whitened<value_t<W, Real>> at;
    value_t<W, Real> alpha;
    mask_t<W> hit;   ///< alpha is at least `least_alpha`
    mask_t<W> free;  ///< alpha is not capped, so that geometry and opacity move it

    WARPAGG_HD coverage(const splat<Real>& s, const patch<W, Real>& p)
        : at(s.p, s.q, s.r, p.x - s.x, p.y - s.y) {
        const value_t<W, Real> sigma = at.exponent();
        hit = sigma <= value_t<W, Real>(s.reach);
        const value_t<W, Real> full = s.opacity * warpagg::math::exp2(-sigma);
        free = full < value_t<W, Real>(Real(most_alpha));
        alpha = warpagg::math::min(full, value_t<W, Real>(Real(most_alpha)));
    }
};

}  // namespace gs::raster
