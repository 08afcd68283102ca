// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "ssim_window.hpp"

namespace gs::train {

/// The SSIM of a render x and a target y at a pixel p, and the coefficients of its derivative.
///
/// The SSIM depends on the values under the window w of the pixel. Its derivative with respect to
/// the render's value at q is
///
///     w(p - q) (constant + by_sum (x + y)(q) + by_difference (x - y)(q)).
template <class V>
struct ssim_terms {
    using Real = warpagg::scalar_t<V>;
    V factor1, factor2;  ///< the SSIM is their product
    V constant;          ///< dSSIM/dx, term independent of the pixel value
    V by_sum;            ///< dSSIM/dx, coefficient of x + y
    V by_difference;     ///< dSSIM/dx, coefficient of x - y

    /// Computes the terms from the moments of u = 2 (x + y) and v = 2 (x - y) under the window.
    ///
    /// With the means m, variances v and covariance cov of x and y (Wang et al. 2004),
    ///
    ///     SSIM = (2 mx my + C1) (2 cov + C2) / ((mx^2 + my^2 + C1) (vx + vy + C2)).
    ///
    /// In terms of u and v, rounding keeps each of the two factors in [-1, 1]. The divisors are at
    /// least C1 and C2, so they meet the preconditions of `warpagg::math::divide`.
    static WARPAGG_HD ssim_terms of(const moments<V>& u, const moments<V>& v) {
        using warpagg::math::divide;
        constexpr auto C1 = static_cast<Real>(8 * 0.01 * 0.01), C2 = static_cast<Real>(8 * 0.03 * 0.03);
        const V mu = u.mean, mv = v.mean, vu = u.square, vv = v.square;
        const V r1 = divide(V(1), fma(mu, mu, mv * mv) + C1), r2 = divide(V(1), vu + vv + C2);
        const V t1 = (mv + mv) * r1, lost1 = mv * t1, factor1 = Real(1) - lost1;
        const V lost2 = (vv + vv) * r2, factor2 = Real(1) - lost2;
        const V scale = Real(8) * factor1 * r2;
        const V by_u = scale * lost2, by_v = scale * (lost2 - Real(2));
        const V by_mean = (t1 + t1) * factor2 * (fma(mu, t1, lost1) - Real(2));
        return {factor1, factor2, by_mean - Real(0.5) * fma(by_u, mu, by_v * mv), by_u, by_v};
    }
};

}  // namespace gs::train
