// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "../core/lane_math.hpp"

namespace gs {

inline constexpr double sh_c0 = 0.28209479177387814;  ///< harmonic of degree 0: 1 / (2 sqrt(pi))

/// Returns the coefficient of degree 0 of a color: the solution of color = 0.5 + sh_c0 *
/// coefficient.
WARPAGG_HD constexpr float sh_from_color(float color) { return (color - 0.5f) / static_cast<float>(sh_c0); }

/// Computes the real spherical harmonics up to `degree`, at most 3, at a unit vector d. Their order
/// and signs are those of the reference implementation (Kerbl et al. 2023). `basis` has (degree +
/// 1)^2 elements.
template <class Real>
WARPAGG_HD void sh_basis(int degree, const glm::vec<3, Real>& d, Real* basis) {
    const auto c = [](double x) { return constant<Real>(x); };
    const Real x = d.x, y = d.y, z = d.z;
    basis[0] = c(sh_c0);
    if (degree < 1) return;
    basis[1] = c(-0.4886025119029199) * y;
    basis[2] = c(0.4886025119029199) * z;
    basis[3] = c(-0.4886025119029199) * x;
    if (degree < 2) return;
    const Real xx = x * x, yy = y * y, zz = z * z;
    basis[4] = c(1.0925484305920792) * x * y;
    basis[5] = c(-1.0925484305920792) * y * z;
    basis[6] = c(0.31539156525252005) * (2 * zz - xx - yy);
    basis[7] = c(-1.0925484305920792) * x * z;
    basis[8] = c(0.5462742152960396) * (xx - yy);
    if (degree < 3) return;
    basis[9] = c(-0.5900435899266435) * y * (3 * xx - yy);
    basis[10] = c(2.890611442640554) * x * y * z;
    basis[11] = c(-0.4570457994644658) * y * (4 * zz - xx - yy);
    basis[12] = c(0.3731763325901154) * z * (2 * zz - 3 * xx - 3 * yy);
    basis[13] = c(-0.4570457994644658) * x * (4 * zz - xx - yy);
    basis[14] = c(1.445305721320277) * z * (xx - yy);
    basis[15] = c(-0.5900435899266435) * x * (xx - 3 * yy);
}

/// Returns the gradient, with respect to d, of the sum of `weight[k] * basis[k]` as polynomials in
/// d.
template <class Real>
WARPAGG_HD glm::vec<3, Real> sh_gradient(int degree, const glm::vec<3, Real>& d, const Real* weight) {
    using vec3 = glm::vec<3, Real>;
    const auto c = [](double x) { return constant<Real>(x); };
    const Real x = d.x, y = d.y, z = d.z;
    vec3 g(0);
    if (degree < 1) return g;
    g += c(0.4886025119029199) * vec3(-weight[3], -weight[1], weight[2]);
    if (degree < 2) return g;
    g += c(1.0925484305920792) *
         (weight[4] * vec3(y, x, 0) - weight[5] * vec3(0, z, y) - weight[7] * vec3(z, 0, x));
    g += c(0.31539156525252005) * weight[6] * vec3(-2 * x, -2 * y, 4 * z);
    g += c(0.5462742152960396) * weight[8] * vec3(2 * x, -2 * y, 0);
    if (degree < 3) return g;
    const Real xx = x * x, yy = y * y, zz = z * z, xy = x * y, yz = y * z, xz = x * z;
    g += c(-0.5900435899266435) * weight[9] * vec3(6 * xy, 3 * xx - 3 * yy, 0);
    g += c(2.890611442640554) * weight[10] * vec3(yz, xz, xy);
    g += c(-0.4570457994644658) * weight[11] * vec3(-2 * xy, 4 * zz - xx - 3 * yy, 8 * yz);
    g += c(0.3731763325901154) * weight[12] * vec3(-6 * xz, -6 * yz, 6 * zz - 3 * xx - 3 * yy);
    g += c(-0.4570457994644658) * weight[13] * vec3(4 * zz - 3 * xx - yy, -2 * xy, 8 * xz);
    g += c(1.445305721320277) * weight[14] * vec3(2 * xz, -2 * yz, xx - yy);
    g += c(-0.5900435899266435) * weight[15] * vec3(3 * xx - 3 * yy, -6 * xy, 0);
    return g;
}

}  // namespace gs
