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

/// Helpers for formulas that run on one Gaussian or on several. `Real` is a number, or a
/// `warpagg::simd_value`, which holds one number per Gaussian.
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
        // exp2 of SIMD values saturates, but an overflow must stay visible as an infinity.
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
/// Satisfies the static assertions of GLM.
template <class T, int L>
struct std::numeric_limits<warpagg::simd_value<T, L>> : std::numeric_limits<T> {};
