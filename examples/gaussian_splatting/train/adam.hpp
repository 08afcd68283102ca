// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <warpagg/simt/warp.hpp>

namespace gs::train {

/// One step of Adam (Kingma and Ba 2015, algorithm 1, with the corrections of bias folded into the rate): one
/// index a value.
template <class Real>
struct adam {
    Real* values;
    Real* first;  ///< moments
    Real* second;
    const Real* gradients;
    Real rate;                       ///< of this step: alpha / (1 - beta1^t)
    Real correction;                 ///< 1 / sqrt(1 - beta2^t)
    const std::uint64_t* instances;  ///< of the view, and how many were reserved: a step whose lists
    std::uint64_t reserved;          ///< did not fit saw half a picture, and is left out

    static constexpr double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-15;

    WARPAGG_HD bool skip() const { return *instances > reserved; }

    WARPAGG_HD void operator()(std::size_t i) const {
        const Real g = gradients[i];
        const Real m = Real(beta1) * first[i] + Real(1 - beta1) * g;
        const Real v = Real(beta2) * second[i] + Real(1 - beta2) * g * g;
        first[i] = m;
        second[i] = v;
        values[i] -= rate * m / (warpagg::math::sqrt(v) * correction + Real(epsilon));
    }
};

}  // namespace gs::train
