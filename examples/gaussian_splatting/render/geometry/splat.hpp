// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/warp/concept.hpp>

namespace gs::raster {

// knob: tile_size
inline constexpr int tile_size = 16;  ///< pixels along a side of a tile, the unit of binning

/// A Gaussian as the image sees it. Its alpha at offset d from its center is 2^(log2_opacity - u^2 - v^2)
/// with u = p dx and v = q dy + r dx, and zero where the exponent u^2 + v^2 exceeds `cutoff`, where alpha
/// falls below `least_alpha`. As a sum of squares the exponent is never negative, however long and thin the
/// splat is. Lane values as `Real` are several splats.
template <class Real>
struct alignas(16) alignas(Real) splat {
    // The first eight say which pixels it reaches.
    Real x, y;                  ///< pixels
    Real p, q, r;               ///< Cholesky factor of the inverse covariance over 2 ln 2
    Real dx_per_dy, dy_per_dx;  ///< the dx of least exponent at a given dy, over dy; and the other way round
    Real cutoff;                ///< log2(opacity / least_alpha); zero or less draws nothing
    Real log2_opacity;          ///< log2(opacity)
    Real red, green, blue;
};

inline constexpr double least_alpha = 1.0 / 255;  // knob: least_alpha
inline constexpr double most_alpha = 0.99;
inline constexpr double least_transmittance = 1e-4;  // knob: least_transmittance

/// The values of a splat, in the order above.
inline constexpr unsigned splat_width = 12;

/// Offsets in units of the splat's own width: the exponent is u^2 + v^2.
template <class V>
struct whitened {
    V u, v;

    WARPAGG_HD whitened(const V& p, const V& q, const V& r, const V& dx, const V& dy)
        : u(dx * p), v(warpagg::math::fma(q, dy, dx * r)) {}

    WARPAGG_HD V exponent() const { return warpagg::math::fma(u, u, v * v); }
};

/// The least exponent over the offsets [x0, x1] × [y0, y1]. The form is convex: the minimum is at the center
/// if the box holds it, else on one of the two sides that face it. Each lane may have a splat of its own.
template <class V>
WARPAGG_HD V least_exponent(const V& p, const V& q, const V& r, const V& dx_per_dy, const V& dy_per_dx,
                            const V& x0, const V& x1, const V& y0, const V& y1) {
    using warpagg::math::not_above;
    using warpagg::math::not_below;
    const V zero(0);
    const V x = not_above(not_below(zero, x0), x1);  // the side's abscissa, or zero inside
    const V y = not_above(not_below(zero, y0), y1);
    const V y_on = not_above(not_below(dy_per_dx * x, y0), y1);
    const V x_on = not_above(not_below(dx_per_dy * y, x0), x1);
    return warpagg::math::min(whitened<V>(p, q, r, x, y_on).exponent(),
                              whitened<V>(p, q, r, x_on, y).exponent());
}

}  // namespace gs::raster
