// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vectors.hpp"

namespace gs::raster {

/// Pixels; what the covariance of a splat is widened by, the variance of a pixel's filter (Kerbl et al.
/// 2023).
inline constexpr double pixel_variance = 0.3;

/// The shape of a splat: the Cholesky factor of the inverse of its covariance over 2 ln 2, from the vectors
/// whose Gram matrix the covariance is before it is widened. The determinant is a square by Lagrange's
/// identity and what the widening adds: a sum of positive terms, so nothing cancels. Sizes are divided out
/// first, so nothing overflows either. NaN where the vectors are not finite.
template <class Real>
struct ellipse {
    Real p, q, r;               ///< see `splat`
    Real dx_per_dy, dy_per_dx;  ///< see `splat`
    Real width, height;         ///< half the bounding box's sides where the exponent is 1

    ellipse() = default;
    WARPAGG_HD ellipse(const vec3<Real>& ax, const vec3<Real>& ay) {
        using warpagg::math::max;
        using warpagg::math::sqrt;
        const Real two_ln2 = constant<Real>(1.3862943611198906), added = constant<Real>(pixel_variance);
        // The variances are size_x^2 xx and size_y^2 yy, the determinant (size_x across)^2 times
        // `determinant`.
        const Real size_x = max(Real(1), largest(ax)), size_y = max(Real(1), largest(ay));
        const vec3<Real> bx = ax / size_x, by = ay / size_y;
        const Real xx = glm::dot(bx, bx) + added / size_x / size_x;
        const Real yy = glm::dot(by, by) + added / size_y / size_y, xy = glm::dot(bx, by);
        const vec3<Real> area = glm::cross(bx, ay);
        const Real ratio = size_y / size_x, across = max(max(Real(1), ratio), largest(area));
        const vec3<Real> part = area / across, long_y = by * (ratio / across);
        const Real determinant =
            // mutate: determinant_by_difference
            glm::dot(part, part) + added * (xx / across / across + glm::dot(long_y, long_y));
        const Real k = sqrt(two_ln2);
        width = k * size_x * sqrt(xx);
        height = k * size_y * sqrt(yy);
        dx_per_dy = xy / yy / ratio;
        dy_per_dx = xy / xx * ratio;
        p = 1 / width;
        q = sqrt(xx / (two_ln2 * determinant)) / across;
        r = -q * dy_per_dx;
    }

    WARPAGG_HD flag_of<Real> is_sound() const {
        return is_finite(width) && is_finite(height) && is_finite(q) && is_finite(r) && is_finite(dx_per_dy);
    }
};

}  // namespace gs::raster
