// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <warpagg/core/math.hpp>

#include "../../core/lane_math.hpp"
#include "../../model/aosoa.hpp"

namespace gs::raster {

template <class Real>
using vec2 = glm::vec<2, Real>;
template <class Real>
using vec3 = glm::vec<3, Real>;
template <class Real>
using vec4 = glm::vec<4, Real>;
template <class Real>
using mat3 = glm::mat<3, 3, Real>;

template <class Real>
WARPAGG_HD flag_of<Real> is_finite(const Real& x) {
    return x - x == Real(0);
}
template <class Real>
WARPAGG_HD flag_of<Real> is_finite(const vec3<Real>& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

/// Returns the largest magnitude of a component.
template <int N, class Real>
WARPAGG_HD Real largest(const glm::vec<N, Real>& v) {
    Real most(0);
    for (int k = 0; k < N; ++k) most = warpagg::math::max(most, magnitude(v[k]));
    return most;
}

/// The direction of a vector, and the inverse of its length. Divides by the largest component
/// first, so that no square overflows or underflows. The values are NaN only for vectors that are
/// zero or not finite.
template <int N, class Real>
struct unit {
    glm::vec<N, Real> direction;
    Real inverse_length;

    WARPAGG_HD explicit unit(const glm::vec<N, Real>& v) {
        const Real most = largest(v);  // mutate: quaternion_squared_first
        const glm::vec<N, Real> scaled = v / most;
        const Real inverse = 1 / warpagg::math::sqrt(glm::dot(scaled, scaled));
        direction = scaled * inverse;
        inverse_length = inverse / most;
    }
};

/// Load or store the components of Gaussian i in an array with 3 or 4 components per Gaussian: see
/// `aosoa_index`.
/// @{
template <class Real>
WARPAGG_HD vec3<Real> load3(const Real* p, unsigned i) {
    return {p[aosoa_index(i, 0, 3)], p[aosoa_index(i, 1, 3)], p[aosoa_index(i, 2, 3)]};
}
template <class Real>
WARPAGG_HD void store3(Real* p, unsigned i, const vec3<Real>& v) {
    for (int k = 0; k < 3; ++k) p[aosoa_index(i, static_cast<unsigned>(k), 3)] = v[k];
}

template <class Real>
WARPAGG_HD vec4<Real> load4(const Real* p, unsigned i) {
    return {p[aosoa_index(i, 0, 4)], p[aosoa_index(i, 1, 4)], p[aosoa_index(i, 2, 4)],
            p[aosoa_index(i, 3, 4)]};
}
/// @}

}  // namespace gs::raster
