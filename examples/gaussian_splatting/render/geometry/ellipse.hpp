// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vectors.hpp"

namespace gs::raster {

/// The variance of the pixel filter in square pixels. It is added to the diagonal of the covariance
/// of each splat (Kerbl et al. 2023).
inline constexpr double pixel_variance = 0.3;

/// The shape of a splat: the Cholesky factor of its inverse covariance over 2 ln 2, in pixels. It
/// is computed from two vectors whose Gram matrix is the covariance without the pixel filter.
///
/// By Lagrange's identity, the determinant is the squared length of a cross product plus the terms
/// of the pixel filter. All terms are positive, so nothing cancels. The sizes of the vectors are
/// divided out first, so that nothing overflows. Values are NaN if the vectors are not finite.
template <class Real>
struct ellipse {
    Real p, q, r;               ///< see `splat`
    Real dx_per_dy, dy_per_dx;  ///< see `splat`
    Real width, height;         ///< half the sides of the bounding box of exponent 1

    ellipse() = default;
    WARPAGG_HD ellipse(const vec3<Real>& ax, const vec3<Real>& ay) {
        using warpagg::math::max;
        using warpagg::math::sqrt;
        const Real two_ln2 = constant<Real>(1.3862943611198906), added = constant<Real>(pixel_variance);
        // The variances are size_x^2 xx and size_y^2 yy. The determinant of the covariance is
        // (size_x across)^2 times `determinant`.
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
