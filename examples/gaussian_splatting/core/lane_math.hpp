// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <limits>
#include <type_traits>
#include <utility>
#include <warpagg/warp/concept.hpp>

namespace gs {

/// What is computed of a Gaussian is written for a `Real` that is a number, or SIMD registers that hold one
/// number for each of several Gaussians (`warpagg::simd_value`).
/// @{
template <class Real>
using flag_of = decltype(std::declval<Real>() < std::declval<Real>());

template <class Real>
WARPAGG_HD constexpr Real constant(double x) {
    return Real(static_cast<warpagg::scalar_t<Real>>(x));
}
template <class Real>
WARPAGG_HD Real magnitude(const Real& x) {
    if constexpr (std::is_arithmetic_v<Real>) {
        return glm::abs(x);
    } else {
        return max(x, -x);
    }
}
template <class Real>
WARPAGG_HD Real exponential(const Real& x) {
    if constexpr (std::is_arithmetic_v<Real>) {
        return glm::exp(x);
    } else {
        // exp2 saturates at the largest number, but an overflow has to remain visible.
        using limits = std::numeric_limits<Real>;
        const Real log2 = x * constant<Real>(1.4426950408889634);
        return select(log2 < Real(limits::max_exponent), exp2(log2), Real(limits::infinity()));
    }
}
/// @}

}  // namespace gs

namespace warpagg {
template <class T, int L>
struct simd_value;
}
/// For GLM's assertions.
template <class T, int L>
struct std::numeric_limits<warpagg::simd_value<T, L>> : std::numeric_limits<T> {};
