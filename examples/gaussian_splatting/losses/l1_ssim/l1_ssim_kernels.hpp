// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../metrics/comparison_kernels.hpp"

namespace gs::train {

/// Computes the gradient, with respect to the render x, of
///
///     (1 - ssim_weight) mean|x - y| + ssim_weight (1 - mean SSIM),
///
/// and zero at masked pixels. Reads the maps that the two passes of a comparison have written. One
/// warp per strip of the `own` rows.
template <class Real, bool Masked>
struct l1_ssim_gradient {
    const std::uint32_t* target;  ///< premultiplied RGBA bytes
    comparison_maps<Real> maps;
    ssim_window<Real> window;
    row_range own;
    int rows;  ///< rows per strip
    Real ssim_weight;
    Real* gradient;  ///< three planes without the frame of `framed_planes`

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        constexpr int radius = ssim_window<Real>::radius, size = ssim_window<Real>::size;
        const framed_planes& planes = maps.planes;
        const ssim_strip<W> strip(w, index, planes.width, own, rows);
        const Real each = Real(1) / (Real(3) * Real(planes.width) * Real(planes.height));
        const Real step = each * (Real(1) - ssim_weight), slope = each * ssim_weight;
        real spread[3][size];  // knob: ssim_spread
        WARPAGG_UNROLL
        for (int m = 0; m < 3; ++m) {
            WARPAGG_UNROLL
            for (int k = 0; k < size; ++k) spread[m][k] = real(0);
        }
        std::ptrdiff_t at = planes.at(strip.channel, strip.first - radius) + strip.left;
        const std::ptrdiff_t plane =
            static_cast<std::ptrdiff_t>(strip.channel) * planes.height * planes.width;
        std::ptrdiff_t to = plane + static_cast<std::ptrdiff_t>(strip.first) * planes.width + strip.left;
        for (int below = strip.first - radius; below < strip.last + radius; ++below, at += planes.pitch()) {
            const Real* const derivatives[] = {maps.constant + at, maps.by_sum + at, maps.by_difference + at};
            real mean[3];
            window.mean_along(map_values<W, Real, 3>{w, derivatives}, mean);
            WARPAGG_UNROLL
            for (int m = 0; m < 3; ++m) window.add_row(spread[m], mean[m]);
            if (below < strip.first + radius) continue;

            const std::ptrdiff_t pixel = at - radius * planes.pitch();
            const real u = w.load_row(maps.sum, pixel, strip.inside),
                       v = w.load_row(maps.difference, pixel, strip.inside);
            const real by_ssim =
                fma(v, spread[2][size - 1], fma(u, spread[1][size - 1], spread[0][size - 1]));
            const real sign = select(v > Real(0), real(step), select(v < Real(0), real(-step), real(0)));
            real by_x = sign - by_ssim * slope;
            if constexpr (Masked)
                by_x = select(is_masked(w, target, to - plane, strip.inside), real(0), by_x);
            w.store_row(gradient, to, by_x, strip.inside);
            to += planes.width;
        }
    }
};

}  // namespace gs::train
