// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/simt/warp.hpp>

namespace gs::raster {

inline constexpr int tile_size = 16;  ///< pixels along a side of a tile, the unit of binning

/// A Gaussian as the picture sees it. Its alpha at offset d from its centre is
/// `opacity * 2^-(a dx^2 + b dx dy + c dy^2)`, and zero where the exponent exceeds `reach`, where alpha falls
/// below `least_alpha`.
template <class Real>
struct alignas(16) splat {
    Real x, y;   ///< pixels
    Real reach;  ///< log2(opacity / least_alpha); zero or less draws nothing
    Real opacity;
    Real a, b, c;  ///< upper half of the inverse covariance over 2 ln 2, off-diagonal twice
    Real unused;
    Real red, green, blue;
    Real unused2;
};

inline constexpr double least_alpha = 1.0 / 255;
inline constexpr double most_alpha = 0.99;
inline constexpr double least_transmittance = 1e-4;

/// The exponent of a splat at an offset. Forward and backward share it and its rounding is pinned, so that
/// both see the same alpha to the bit.
template <class V, class Real>
WARPAGG_HD V exponent(const splat<Real>& s, const V& dx, const V& dy) {
    using warpagg::math::fma;
    return fma(dx, fma(V(s.b), dy, dx * s.a), (dy * s.c) * dy);
}

/// The least exponent of a quadratic form over the offsets [x0, x1] × [y0, y1]. The form is convex: the
/// minimum is at the centre if the box holds it, else on one of the two sides that face it.
template <class V>
WARPAGG_HD V least_exponent(const V& a, const V& b, const V& c, const V& x0, const V& x1, const V& y0,
                            const V& y1) {
    using warpagg::math::max;
    using warpagg::math::min;
    using warpagg::math::select;
    const V zero(0);
    const V x = min(max(zero, x0), x1);  // the side's abscissa, or zero inside
    const V y = min(max(zero, y0), y1);
    // Along the side at x the form is least at y = -b x / 2c, and along the one at y at x = -b y / 2a.
    const V y_on = min(max(-b * x / (c + c), y0), y1);
    const V x_on = min(max(-b * y / (a + a), x0), x1);
    const V at_x = a * x * x + b * x * y_on + c * y_on * y_on;
    const V at_y = a * x_on * x_on + b * x_on * y + c * y * y;
    return min(at_x, at_y);
}

}  // namespace gs::raster
