// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <warpagg/atomic.hpp>

#include "../render/geometry/list_capacity.hpp"
#include "comparison_totals.hpp"
#include "ssim_strip.hpp"
#include "ssim_terms.hpp"
#include "target_pixels.hpp"

namespace gs::train {

/// The intermediate results of a comparison of a render x with a target y, as framed planes.
///
/// The SSIM at a pixel p depends on the values under its window w. Its derivative with respect to
/// the render's value at q is
///
///     w(p - q) (constant(p) + by_sum(p) (x + y)(q) + by_difference(p) (x - y)(q)).
template <class Real>
struct comparison_maps {
    framed_planes planes;
    Real* sum;            ///< x + y
    Real* difference;     ///< x - y
    Real* constant;       ///< dSSIM/dx, term independent of the pixel value
    Real* by_sum;         ///< dSSIM/dx, coefficient of x + y
    Real* by_difference;  ///< dSSIM/dx, coefficient of x - y

    static constexpr std::size_t count = 5;
    static comparison_maps in(Real* memory, const framed_planes& planes) {
        const std::size_t n = planes.size();
        return {planes, memory, memory + n, memory + 2 * n, memory + 3 * n, memory + 4 * n};
    }
};

/// First pass: writes the sum and the difference of the render and of the target on its background.
/// The SSIM is simplest in terms of these two. They are zero at masked pixels. Also writes zeros to
/// the frames of all maps and to the values after their end. Skips rows on which the gradient in the
/// `own` rows does not depend. One warp per `W::size` consecutive values of a line.
template <class Real, bool Masked>
struct sum_and_difference {
    const std::uint32_t* target;  ///< premultiplied RGBA bytes
    const Real* render;
    glm::vec<3, Real> background;
    comparison_maps<Real> maps;
    row_range own;

    template <class W>
    static std::size_t count(const framed_planes& planes) {
        return planes.size() / W::size;
    }

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const framed_planes& planes = maps.planes;
        const auto per_line = static_cast<unsigned>(planes.pitch()) / W::size;
        const auto line = static_cast<int>(index / per_line);
        const auto left = static_cast<int>(index % per_line * W::size);
        const int framed = planes.frame + planes.height;
        const int channel = (line - 1) / framed, row = (line - 1) % framed - planes.frame;
        const std::ptrdiff_t to = line * planes.pitch() + left;
        Real* const derivatives[] = {maps.constant, maps.by_sum, maps.by_difference};
        const real zero(0);
        if (row < 0 || channel > 2 || left >= planes.width) {
            w.store_row(maps.sum, to, zero, true);
            w.store_row(maps.difference, to, zero, true);
            for (Real* map : derivatives) w.store_row(map, to, zero, true);
            return;
        }
        const row_range read = own.grown(2 * ssim_window<Real>::radius, planes.height);
        if (row < read.first || row >= read.last) return;
        const mask_t<W> inside = w.lane() < static_cast<unsigned>(planes.width - left);
        if (w.any(!inside)) {
            for (Real* map : derivatives) w.store_row(map, to, zero, !inside);
        }

        const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(row) * planes.width + left;
        const value_t<W, unsigned> rgba = w.load_row(target, pixel, inside);
        const real y = target_value<W>(rgba, channel, background[channel]);
        const auto plane = static_cast<std::ptrdiff_t>(planes.width) * planes.height;
        const real x = w.load_row(render, channel * plane + pixel, inside);
        mask_t<W> counts = inside;
        if constexpr (Masked) counts = counts && rgba != value_t<W, unsigned>(masked_pixel);
        w.store_row(maps.sum, to, select(counts, x + y, zero), true);
        w.store_row(maps.difference, to, select(counts, x - y, zero), true);
    }
};

/// Second pass: computes the SSIM at each pixel and the coefficients of its derivative, for the `own`
/// rows and those that the gradient there depends on. Adds its own rows to `totals` unless the tile
/// lists of the view did not fit. Masked pixels do not count. One warp per strip of `strip_rows`.
template <class Real, bool Masked>
struct ssim_compare {
    const std::uint32_t* target;
    comparison_maps<Real> maps;
    ssim_window<Real> window;
    row_range own;
    int rows;                        ///< rows per strip
    double* totals;                  ///< one sum per `comparison_total`
    raster::list_capacity capacity;  // knob: ssim_capacity

    static WARPAGG_HD row_range strip_rows(const row_range& own, int height) {
        return own.grown(ssim_window<Real>::radius, height);
    }

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        constexpr int radius = ssim_window<Real>::radius, size = ssim_window<Real>::size;
        const framed_planes& planes = maps.planes;
        const ssim_strip<W> strip(w, index, planes.width, strip_rows(own, planes.height), rows);
        // knob: ssim_moments
        moments<real> sums[size], differences[size];  // of the windows that contain the current row
        WARPAGG_UNROLL
        for (int k = 0; k < size; ++k) sums[k] = differences[k] = {real(0), real(0)};
        real absolute(0), square(0), ssim(0);
        int rows_of_totals = 0;
        [[maybe_unused]] real excluded(0);
        std::ptrdiff_t at = planes.at(strip.channel, strip.first - radius) + strip.left;
        for (int below = strip.first - radius; below < strip.last + radius; ++below, at += planes.pitch()) {
            const Real* const values[] = {maps.sum + at, maps.difference + at};
            moments<real> along[2];
            window.moments_along(map_values<W, Real, 2>{w, values}, along);
            window.add_row(sums, along[0]);
            window.add_row(differences, along[1]);
            if (below < strip.first + radius) continue;

            const ssim_terms<real> terms = ssim_terms<real>::of(sums[size - 1], differences[size - 1]);
            const std::ptrdiff_t pixel = at - radius * planes.pitch();
            w.store_row(maps.constant, pixel, terms.constant, strip.inside);
            w.store_row(maps.by_sum, pixel, terms.by_sum, strip.inside);
            w.store_row(maps.by_difference, pixel, terms.by_difference, strip.inside);

            if (below - radius < own.first || below - radius >= own.last) continue;
            ++rows_of_totals;
            const real error = w.load_row(maps.difference, pixel, strip.inside);
            absolute += warpagg::math::max(error, -error);
            square = fma(error, error, square);
            real counted2 = terms.factor2;
            if constexpr (Masked) counted2 = counted(w, strip, below - radius, terms.factor2, excluded);
            ssim = fma(terms.factor1, counted2, ssim);
        }
        if (capacity.exceeded()) return;
        using warpagg::math::convert;
        value_t<W, double> values(static_cast<double>(rows_of_totals));
        if constexpr (Masked) values = values - convert<double>(excluded);
        const value_t<W, double> found[comparison_total_count] = {
            convert<double>(absolute), convert<double>(square), convert<double>(ssim), values};
        warpagg::warp_reduce_atomic(w, totals, found, strip.inside);
    }

  private:
    /// Returns the value, or zero at masked pixels, which it counts in `excluded`.
    template <class W, class real>
    WARPAGG_HD real counted(const W& w, const ssim_strip<W>& strip, int row, const real& value,
                            real& excluded) const {
        const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(row) * maps.planes.width + strip.left;
        const mask_t<W> out = is_masked(w, target, pixel, strip.inside);
        excluded += select(out, real(1), real(0));
        return select(out, real(0), value);
    }
};

}  // namespace gs::train
