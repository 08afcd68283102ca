// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <warpagg/warp/concept.hpp>

#include "../render/geometry/list_capacity.hpp"

namespace gs::train {

/// Sums over a picture, each in as many parts as warps add pixels up. The parts are added up in their order:
/// whichever warp ends first, the bits are the same. Zeros before a picture.
struct picture_sums {
    float* parts;
    std::size_t warps;

    WARPAGG_HD float* operator()(unsigned number, std::size_t warp) const {
        return parts + number * warps + warp;
    }
};

/// Adam's step (see `adam`) of numbers whose gradients are such sums: a warp for each. Leaves zeros in its
/// sum. A gradient that is not finite is left out, and so is a step without room for the view's lists.
struct learn_from_sums {
    picture_sums sums;
    float *values, *first, *second;  ///< and the moments
    float rate, correction;          ///< alpha / (1 - beta1^t), 1 / sqrt(1 - beta2^t)
    raster::list_room room;

    static constexpr float beta1 = 0.9f, beta2 = 0.999f, epsilon = 1e-15f;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned number) const {
        using real = warpagg::value_t<W, float>;
        using mask = warpagg::mask_t<W>;
        real g(0);
        for (std::size_t warp = 0; warp < sums.warps; warp += W::size) {
            const std::size_t left = sums.warps - warp;
            const mask inside = w.lane() < static_cast<unsigned>(left < W::size ? left : W::size);
            g += w.load_row(sums(number, warp), 0, inside);
            w.store_row(sums(number, warp), 0, real(0), inside);
        }
        for (unsigned distance = W::size / 2; distance > 0; distance /= 2) g += w.shfl_xor(g, distance);
        if (room.exceeded()) return;
        const mask learns = w.lane() == 0u && g > real(-1e18f) && g < real(1e18f);
        const real m = real(beta1) * w.load_row(first, number, learns) + real(1 - beta1) * g;
        const real v = real(beta2) * w.load_row(second, number, learns) + real(1 - beta2) * g * g;
        const real step = real(rate) * m / (real(correction) * warpagg::math::sqrt(v) + real(epsilon));
        w.store_row(first, number, m, learns);
        w.store_row(second, number, v, learns);
        w.store_row(values, number, w.load_row(values, number, learns) - step, learns);
    }
};

}  // namespace gs::train
