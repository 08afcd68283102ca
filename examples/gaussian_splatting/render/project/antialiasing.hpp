// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../geometry/ellipse.hpp"

namespace gs::raster {

/// The two vectors whose Gram matrix is the covariance of a splat without the pixel filter, in
/// units of the width of the drawn splat: see `whitened`. Each is at most 1 / sqrt(2 ln 2) long.
template <class Real>
struct whitened_axes {
    vec3<Real> x, y;

    WARPAGG_HD whitened_axes(const ellipse<Real>& shape, const vec3<Real>& ax, const vec3<Real>& ay)
        : x(shape.p * ax), y(shape.r * ax + shape.q * ay) {}
};

/// Returns the opacity factor of the 2D Mip filter (Yu et al. 2024, equation 9): the square root of
/// det(covariance) / det(covariance with the pixel filter), at most 1. With this factor, a splat
/// that is much smaller than a pixel keeps its total light, although the pixel filter widens it.
template <class Real>
WARPAGG_HD Real opacity_left(const whitened_axes<Real>& axes) {
    const vec3<Real> area = glm::cross(axes.x, axes.y);
    return constant<Real>(1.3862943611198906) * warpagg::math::sqrt(glm::dot(area, area));
}

/// Adds the gradient through `opacity_left` to the gradients of the whitened axes. `by_logarithm`:
/// the gradient with respect to the logarithm of the opacity. Precondition: `opacity_left` is not
/// zero where `by_logarithm` is not zero.
template <class Real>
WARPAGG_HD void add_opacity_left_gradient(const whitened_axes<Real>& axes, const Real& by_logarithm,
                                          vec3<Real>& by_x, vec3<Real>& by_y) {
    // The gradient of log |area| with respect to an axis is the cross product of the other axis and
    // the area, over the squared area. The gradient of the logarithm of the drawn ellipse's area,
    // which is subtracted, is 2 ln 2 times the axis.
    const vec3<Real> area = glm::cross(axes.x, axes.y);
    const Real share = by_logarithm / glm::dot(area, area), two_ln2 = constant<Real>(1.3862943611198906);
    by_x += share * glm::cross(axes.y, area) - (by_logarithm * two_ln2) * axes.x;
    by_y += share * glm::cross(area, axes.x) - (by_logarithm * two_ln2) * axes.y;
}

}  // namespace gs::raster
