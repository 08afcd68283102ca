// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <warpagg/atomic.hpp>

#include "../raster/list_room.hpp"

namespace gs::train {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::fma;
using warpagg::math::select;

/// The photo over a background: premultiplied RGBA bytes to three planes in [0, 1]. One index a pixel.
template <class Real>
struct composite {
    const std::uint8_t* rgba;
    glm::vec<3, Real> background;
    std::size_t pixels;
    Real* planes;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::uint8_t* p = rgba + 4 * i;
        const Real through =
            Real(255 - p[3]) / 255;  // 1 where nothing is, which leaves the background as it is
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c) * pixels + i] = Real(p[c]) / 255 + through * background[c];
    }
};

/// The window of the structural similarity: 11 taps of a Gaussian of standard deviation 1.5, normalised
/// (Wang et al. 2004).
struct ssim_window {
    static constexpr int radius = 5;
    double tap[radius + 1];

    static ssim_window make() {
        ssim_window w{};
        double sum = 0;
        for (int i = 0; i <= radius; ++i) {
            w.tap[i] = std::exp(-i * i / (2 * 1.5 * 1.5));
            sum += i == 0 ? w.tap[i] : 2 * w.tap[i];
        }
        for (double& t : w.tap) t /= sum;
        return w;
    }
};

/// A row of pixels as wide as the warp, in one of three planes. What lies outside the picture counts as zero.
template <class W>
struct pixel_row {
    unsigned row, width, height;
    std::ptrdiff_t first;         ///< the row's place in the three planes
    value_t<W, unsigned> column;  ///< of each lane
    mask_t<W> inside;

    static std::size_t count(int width, int height) {
        return 3 * static_cast<std::size_t>(height) *
               ((static_cast<unsigned>(width) + W::size - 1) / W::size);
    }

    WARPAGG_HD pixel_row(const W& w, unsigned index, int width_, int height_)
        : width(static_cast<unsigned>(width_)), height(static_cast<unsigned>(height_)) {
        const unsigned per_line = (width + W::size - 1) / W::size, line = index / per_line;
        const unsigned left = index % per_line * W::size;
        row = line % height;
        first = static_cast<std::ptrdiff_t>(line) * width + left;
        column = w.lane() + left;
        inside = column < width;
    }

    /// f(tap, values of the N maps) for each tap of the window along the row, or along the column if `Down`.
    template <bool Down, int N, class Real, class F>
    WARPAGG_HD void for_each_tap(const W& w, const ssim_window& window, const Real* const (&maps)[N],
                                 const F& f) const {
        for (int t = -ssim_window::radius; t <= ssim_window::radius; ++t) {
            // What is left of the picture, or above it, wraps around.
            const auto shift = static_cast<unsigned>(t);
            const value_t<W, unsigned> at = Down ? value_t<W, unsigned>(row + shift) : column + shift;
            const mask_t<W> there = inside && at < (Down ? height : width);
            const std::ptrdiff_t from = first + (Down ? static_cast<std::ptrdiff_t>(t) * width : t);
            value_t<W, Real> values[N];
            for (int m = 0; m < N; ++m) values[m] = w.load_row(maps[m], from, there);
            f(value_t<W, Real>(static_cast<Real>(window.tap[t < 0 ? -t : t])), values);
        }
    }

    /// The window's mean of each of N maps along the row, or along the column if `Down`.
    template <bool Down, int N, class Real>
    WARPAGG_HD void blur(const W& w, const ssim_window& window, const Real* const (&maps)[N],
                         value_t<W, Real> (&means)[N]) const {
        for (auto& m : means) m = value_t<W, Real>(0);
        for_each_tap<Down>(w, window, maps, [&](const auto& tap, const auto& values) {
            for (int m = 0; m < N; ++m) means[m] = fma(tap, values[m], means[m]);
        });
    }
};

/// What the similarity is made of, a map of three planes each: the means of x and of the difference d = x -
/// y, the sum of the variances of x and of y, and the variance of d. A variance is a sum of squares about the
/// mean, so that none is negative, whatever the rounding.
enum ssim_moment { mean_x, mean_d, variance_sum, variance_d, ssim_moment_count };

/// First pass: the moments along the rows.
template <class Real>
struct ssim_moments {
    const Real* x;
    const Real* y;
    int width, height;
    ssim_window window;
    Real* moments[ssim_moment_count];

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const pixel_row<W> p(w, index, width, height);
        const Real* const pictures[] = {x, y};
        real mean[2];
        p.template blur<false>(w, window, pictures, mean);
        real variance(0), difference(0);
        p.template for_each_tap<false>(w, window, pictures, [&](const real& tap, const real(&at)[2]) {
            const real a = at[0] - mean[0], b = at[1] - mean[1], d = a - b;
            variance = fma(tap, fma(a, a, b * b), variance);
            difference = fma(tap * d, d, difference);
        });
        w.store_row(moments[mean_x], p.first, mean[0], p.inside);
        w.store_row(moments[mean_d], p.first, mean[0] - mean[1], p.inside);
        w.store_row(moments[variance_sum], p.first, variance, p.inside);
        w.store_row(moments[variance_d], p.first, difference, p.inside);
    }
};

/// Where the second pass adds up what it finds over all pixels and channels.
enum loss_sum { sum_absolute, sum_square, sum_ssim, sum_values, loss_sum_count };

/// Second pass: the moments of the whole window, the similarity of each pixel, and its derivatives by the
/// mean of x, and by x through the variances, which are proportional to x and to d. Adds the absolute and
/// square errors, the similarity and the number of values to `totals`.
template <class Real>
struct ssim_compare {
    const Real* x;
    const Real* y;
    int width, height;
    ssim_window window;
    const Real* moments[ssim_moment_count];
    Real* derivatives[3];
    double* totals;  ///< `loss_sum_count`
    raster::list_room room;

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const pixel_row<W> p(w, index, width, height);
        real mx(0), md(0);
        p.template for_each_tap<true>(w, window, moments, [&](const real& tap, const auto& at) {
            mx = fma(tap, at[mean_x], mx);
            md = fma(tap, at[mean_d], md);
        });
        // The variance of the whole is the mean of the rows' variances and the variance of the rows' means.
        real variances(0), difference(0);
        const real my = mx - md;
        p.template for_each_tap<true>(w, window, moments, [&](const real& tap, const auto& at) {
            const real a = at[mean_x] - mx, d = at[mean_d] - md, b = at[mean_x] - at[mean_d] - my;
            variances = fma(tap, at[variance_sum] + fma(a, a, b * b), variances);
            difference = fma(tap, fma(d, d, at[variance_d]), difference);
        });

        // Wang et al.'s (2 mx my + C1)(2 cov + C2) / ((mx^2 + my^2 + C1)(vx + vy + C2)), as
        // (1 - (mx - my)^2 / b1)(1 - var(x - y) / b2): each factor is at most 1.
        constexpr auto C1 = static_cast<Real>(0.01 * 0.01), C2 = static_cast<Real>(0.03 * 0.03);
        const real r1 = Real(1) / (fma(mx, mx, my * my) + C1), r2 = Real(1) / (variances + C2);
        const real t1 = md * r1, t2 = difference * r2;  // of what is lost
        const real like1 = Real(1) - md * t1, like2 = Real(1) - t2;
        const real s = like1 * like2;
        const real by_d = (like1 + like1) * r2, by_x = by_d * t2;
        const real by_mean = (t1 + t1) * like2 * (t1 * mx - Real(1)) + by_d * md - by_x * mx;
        w.store_row(derivatives[0], p.first, by_mean, p.inside);
        w.store_row(derivatives[1], p.first, by_x, p.inside);
        w.store_row(derivatives[2], p.first, -by_d, p.inside);

        if (room.exceeded()) return;
        const real error = w.load_row(x, p.first, p.inside) - w.load_row(y, p.first, p.inside);
        const value_t<W, double> found[loss_sum_count] = {
            warpagg::math::convert<double>(warpagg::math::max(error, -error)),
            warpagg::math::convert<double>(error * error), warpagg::math::convert<double>(s),
            value_t<W, double>(1)};
        warpagg::warp_reduce_atomic(w, totals, found, p.inside);
    }
};

/// Third pass: the derivatives, blurred along the rows.
template <class Real>
struct ssim_spread {
    int width, height;
    ssim_window window;
    const Real* derivatives[3];
    Real* spread[3];

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const pixel_row<W> p(w, index, width, height);
        real sum[3];
        p.template blur<false>(w, window, derivatives, sum);
        for (int m = 0; m < 3; ++m) w.store_row(spread[m], p.first, sum[m], p.inside);
    }
};

/// Last pass: the gradient by x of `(1 - ssim_weight) mean|x - y| + ssim_weight (1 - mean SSIM)`.
template <class Real>
struct loss_gradient {
    const Real* x;
    const Real* y;
    int width, height;
    ssim_window window;
    const Real* spread[3];
    Real ssim_weight;
    Real* gradient;

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const pixel_row<W> p(w, index, width, height);
        real sum[3];
        p.template blur<true>(w, window, spread, sum);
        const real a = w.load_row(x, p.first, p.inside), b = w.load_row(y, p.first, p.inside);
        const real similarity = sum[0] + a * sum[1] + (a - b) * sum[2];
        const Real each = Real(1) / (Real(3) * Real(width) * Real(height));
        const real sign = select(a > b, real(1), select(a < b, real(-1), real(0)));
        const real g = sign * (each * (Real(1) - ssim_weight)) - similarity * (each * ssim_weight);
        w.store_row(gradient, p.first, g, p.inside);
    }
};

}  // namespace gs::train
