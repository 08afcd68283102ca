// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/warp/concept.hpp>

#include "../render/geometry/list_capacity.hpp"

namespace gs::train {

/// Sums over an image that do not depend on the order in which warps finish. Each sum has one part
/// per warp, and the parts are added in a fixed order.
struct ordered_sums {
    float* parts;
    std::size_t warps;

    WARPAGG_HD float* operator()(unsigned sum, std::size_t warp) const { return parts + sum * warps + warp; }
};

/// One step of Adam (Kingma and Ba 2015, algorithm 1) for parameters whose gradients are
/// `ordered_sums`. Sets these sums to zero. A parameter stays as it is if its gradient is not
/// finite or too large to square. All parameters stay as they are if the tile lists of the view did
/// not fit. One warp per parameter.
struct adam_from_sums {
    ordered_sums sums;
    float *values, *first, *second;  ///< parameters, first and second moments
    float rate, correction;          ///< alpha / (1 - beta1^t), 1 / sqrt(1 - beta2^t) in step t
    float beta2;                     ///< decay of the second moments
    raster::list_capacity capacity;

    static constexpr float beta1 = 0.9f, epsilon = 1e-15f;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned parameter) const {
        using real = warpagg::value_t<W, float>;
        using mask = warpagg::mask_t<W>;
        real g(0);
        for (std::size_t warp = 0; warp < sums.warps; warp += W::size) {
            const std::size_t left = sums.warps - warp;
            const mask inside = w.lane() < static_cast<unsigned>(left < W::size ? left : W::size);
            g += w.load_row(sums(parameter, warp), 0, inside);
            w.store_row(sums(parameter, warp), 0, real(0), inside);
        }
        for (unsigned distance = W::size / 2; distance > 0; distance /= 2) g += w.shfl_xor(g, distance);
        if (capacity.exceeded()) return;
        const mask learns = w.lane() == 0u && g > real(-1e18f) && g < real(1e18f);
        const real m = real(beta1) * w.load_row(first, parameter, learns) + real(1 - beta1) * g;
        const real v = real(beta2) * w.load_row(second, parameter, learns) + real(1 - beta2) * g * g;
        const real step = real(rate) * m / (real(correction) * warpagg::math::sqrt(v) + real(epsilon));
        w.store_row(first, parameter, m, learns);
        w.store_row(second, parameter, v, learns);
        w.store_row(values, parameter, w.load_row(values, parameter, learns) - step, learns);
    }
};

}  // namespace gs::train
