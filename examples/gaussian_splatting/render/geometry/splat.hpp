// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/warp/concept.hpp>

namespace gs::raster {

// knob: tile_size
inline constexpr int tile_size = 16;  ///< side of a tile in pixels; splats are binned by tile

/// A Gaussian projected onto the image. At the offset (dx, dy) from its center, its alpha is
/// 2^(log2_opacity - u^2 - v^2) with u = p dx and v = q dy + r dx. Alpha is zero if the exponent
/// u^2 + v^2 exceeds `cutoff`, because it is then below `least_alpha`. The exponent is a sum of
/// squares, so rounding never makes it negative, even for long thin splats. If `Real` is a SIMD
/// value, an object holds one splat per lane.
template <class Real>
struct alignas(16) alignas(Real) splat {
    // The first eight values determine which pixels the splat reaches.
    Real x, y;                  ///< center in pixels
    Real p, q, r;               ///< Cholesky factor of the inverse covariance over 2 ln 2
    Real dx_per_dy, dy_per_dx;  ///< the dx that minimizes the exponent, per dy; and vice versa
    Real cutoff;                ///< log2(opacity / least_alpha); not drawn if zero or less
    Real log2_opacity;          ///< log2(opacity)
    Real red, green, blue;
};

/// Bounds of alpha and of the transmittance of a pixel (Kerbl et al. 2023, reference
/// implementation). A smaller alpha counts as zero, and a larger one is capped. A pixel ends before
/// its transmittance would fall below the bound.
/// @{
inline constexpr double least_alpha = 1.0 / 255;  // knob: least_alpha
inline constexpr double most_alpha = 0.99;
inline constexpr double least_transmittance = 1e-4;  // knob: least_transmittance
/// @}

/// The number of values of a splat.
inline constexpr unsigned splat_width = 12;

/// The offset of a pixel in units of the splat's width, in which the exponent is u^2 + v^2.
template <class V>
struct whitened {
    V u, v;

    WARPAGG_HD whitened(const V& p, const V& q, const V& r, const V& dx, const V& dy)
        : u(dx * p), v(warpagg::math::fma(q, dy, dx * r)) {}

    WARPAGG_HD V exponent() const { return warpagg::math::fma(u, u, v * v); }
};

/// Returns the least exponent over the offsets [x0, x1] × [y0, y1]. The exponent is convex, so its
/// minimum is at the center if the box contains it, and otherwise on one of the two sides that face
/// it. Each lane may have a different splat.
template <class V>
WARPAGG_HD V least_exponent(const V& p, const V& q, const V& r, const V& dx_per_dy, const V& dy_per_dx,
                            const V& x0, const V& x1, const V& y0, const V& y1) {
    using warpagg::math::not_above;
    using warpagg::math::not_below;
    const V zero(0);
    const V x = not_above(not_below(zero, x0), x1);  // position of the facing side; zero inside
    const V y = not_above(not_below(zero, y0), y1);
    const V y_on = not_above(not_below(dy_per_dx * x, y0), y1);
    const V x_on = not_above(not_below(dx_per_dy * y, x0), x1);
    return warpagg::math::min(whitened<V>(p, q, r, x, y_on).exponent(),
                              whitened<V>(p, q, r, x_on, y).exponent());
}

/// Returns the same in an image of this width whose left and right border are the same place. The
/// result may be too small if the offsets reach farther than half the width.
template <class V>
WARPAGG_HD V least_exponent_around(const V& p, const V& q, const V& r, const V& dx_per_dy, const V& dy_per_dx,
                                   const V& x0, const V& x1, const V& y0, const V& y1, const V& width) {
    const V other = warpagg::math::select(x0 + x1 > V(0), -width, width);
    return warpagg::math::min(least_exponent(p, q, r, dx_per_dy, dy_per_dx, x0, x1, y0, y1),
                              least_exponent(p, q, r, dx_per_dy, dy_per_dx, x0 + other, x1 + other, y0, y1));
}

}  // namespace gs::raster
