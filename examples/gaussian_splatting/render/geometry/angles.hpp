// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vectors.hpp"

namespace gs::raster {

using warpagg::math::select;

/// The sine and the cosine of an angle of at most 180 degrees, in either direction. They have the
/// precision of a float.
template <class Real>
struct sine_and_cosine {
    Real sine, cosine;

    /// Sums the series at an eighth of the angle, and doubles the angle three times.
    WARPAGG_HD explicit sine_and_cosine(const Real& angle) {
        const Real one(1), part = angle * constant<Real>(0.125), w = part * part;
        const auto over = [&](double n) { return w * constant<Real>(1 / n); };
        sine = part * (one - over(6) * (one - over(20) * (one - over(42) * (one - over(72)))));
        cosine = one - over(2) * (one - over(12) * (one - over(30) * (one - over(56) * (one - over(90)))));
        for (int doubling = 0; doubling < 3; ++doubling) {
            const Real twice = Real(2) * sine * cosine;
            cosine = one - Real(2) * sine * sine;
            sine = twice;
        }
    }
};

/// Returns the angle, from -pi to pi, of the direction (cosine, sine), which may have any length
/// but zero. It has the precision of `Real`, up to double.
template <class Real>
WARPAGG_HD Real angle_of(const Real& sine, const Real& cosine) {
    using warpagg::math::max;
    using warpagg::math::min;
    const Real one(1), right = constant<Real>(1.5707963267948966),
                       straight = constant<Real>(3.141592653589793);
    const Real up = magnitude(sine), along = magnitude(cosine);
    // The tangent of a quarter of the angle to the nearest axis, which is at most 0.199. Its series
    // converges fast.
    const auto halved = [&](const Real& tangent) {
        return tangent / (one + warpagg::math::sqrt(one + tangent * tangent));
    };
    const Real tangent = halved(halved(min(up, along) / max(up, along))), w = tangent * tangent;
    Real sum(0);
    WARPAGG_UNROLL
    for (int k = 10; k >= 0; --k) sum = constant<Real>(1.0 / (2 * k + 1)) - w * sum;
    Real angle = Real(4) * tangent * sum;
    angle = select(up > along, right - angle, angle);
    angle = select(cosine < Real(0), straight - angle, angle);
    return select(sine < Real(0), -angle, angle);
}

}  // namespace gs::raster
