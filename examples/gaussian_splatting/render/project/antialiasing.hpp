// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../geometry/ellipse.hpp"

namespace gs::raster {

/// The two vectors whose Gram matrix is the covariance of a splat before a pixel's filter widened it, in
/// widths of the splat as it is drawn: each is no longer than 1 / sqrt(2 ln 2).
template <class Real>
struct whitened_axes {
    vec3<Real> x, y;

    WARPAGG_HD whitened_axes(const ellipse<Real>& shape, const vec3<Real>& ax, const vec3<Real>& ay)
        : x(shape.p * ax), y(shape.r * ax + shape.q * ay) {}
};

/// The 2D Mip filter (Yu et al. 2024, equation 9): the square root of the determinant of a splat's covariance
/// before it was widened over that after it, at most 1. With opacity times that, a splat much smaller than a
/// pixel has the light of its own size, and not of the pixel's.
template <class Real>
WARPAGG_HD Real opacity_left(const whitened_axes<Real>& axes) {
    const vec3<Real> area = glm::cross(axes.x, axes.y);
    return constant<Real>(1.3862943611198906) * warpagg::math::sqrt(glm::dot(area, area));
}

/// Adds to the gradients of the whitened axes what they have through `opacity_left`. `by_logarithm`: the
/// gradient by the opacity's logarithm. Precondition: where that is not zero, nor is `opacity_left`.
template <class Real>
WARPAGG_HD void add_opacity_left_gradient(const whitened_axes<Real>& axes, const Real& by_logarithm,
                                          vec3<Real>& by_x, vec3<Real>& by_y) {
    // The logarithm of the area by either axis is the other one's cross product with it, over the area's
    // square; of the ellipse that is divided by, 2 ln 2 times the axis.
    const vec3<Real> area = glm::cross(axes.x, axes.y);
    const Real share = by_logarithm / glm::dot(area, area), two_ln2 = constant<Real>(1.3862943611198906);
    by_x += share * glm::cross(axes.y, area) - (by_logarithm * two_ln2) * axes.x;
    by_y += share * glm::cross(area, axes.x) - (by_logarithm * two_ln2) * axes.y;
}

}  // namespace gs::raster
