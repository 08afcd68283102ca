// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <warpagg/atomic.hpp>

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
        const Real through = Real(255 - p[3]);
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c) * pixels + i] =
                (Real(p[c]) + through * background[c]) * Real(1.0 / 255);
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

    /// Which lanes have a pixel `shift` columns further.
    WARPAGG_HD mask_t<W> has_column(int shift) const {
        return inside &&
               column + static_cast<unsigned>(shift) < width;  // what is left of the picture wraps around
    }

    /// Sums `tap * map` along the row, or along the column if `Down`, over each of N maps.
    template <bool Down, int N, class Real>
    WARPAGG_HD void blur(const W& w, const ssim_window& window, const Real* const (&maps)[N],
                         value_t<W, Real> (&sums)[N]) const {
        for (int t = -ssim_window::radius; t <= ssim_window::radius; ++t) {
            if (Down && row + static_cast<unsigned>(t) >= height) continue;
            const std::ptrdiff_t from = first + (Down ? static_cast<std::ptrdiff_t>(t) * width : t);
            const mask_t<W> there = Down ? inside : has_column(t);
            const value_t<W, Real> tap(static_cast<Real>(window.tap[t < 0 ? -t : t]));
            for (int m = 0; m < N; ++m) sums[m] = fma(tap, w.load_row(maps[m], from, there), sums[m]);
        }
    }
};

/// First pass: the means along the rows of x, y, x^2, y^2 and xy, into five maps of three planes.
template <class Real>
struct ssim_moments {
    const Real* x;
    const Real* y;
    int width, height;
    ssim_window window;
    Real* moments[5];

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const pixel_row<W> p(w, index, width, height);
        real sum[5] = {real(0), real(0), real(0), real(0), real(0)};
        for (int t = -ssim_window::radius; t <= ssim_window::radius; ++t) {
            const mask_t<W> there = p.has_column(t);
            const real tap(static_cast<Real>(window.tap[t < 0 ? -t : t]));
            const real a = w.load_row(x, p.first + t, there), b = w.load_row(y, p.first + t, there);
            sum[0] = fma(tap, a, sum[0]);
            sum[1] = fma(tap, b, sum[1]);
            sum[2] = fma(tap * a, a, sum[2]);
            sum[3] = fma(tap * b, b, sum[3]);
            sum[4] = fma(tap * a, b, sum[4]);
        }
        for (int m = 0; m < 5; ++m) w.store_row(moments[m], p.first, sum[m], p.inside);
    }
};

/// Where the second pass adds up what it finds over all pixels and channels.
enum loss_sum { sum_absolute, sum_square, sum_ssim, loss_sum_count };

/// Second pass: the means along the columns, the similarity of each pixel, and its derivatives by the mean of
/// x, of x^2 and of xy. Adds the absolute and square errors and the similarity to `totals`.
template <class Real>
struct ssim_compare {
    const Real* x;
    const Real* y;
    int width, height;
    ssim_window window;
    const Real* moments[5];
    Real* derivatives[3];
    double* totals;  ///< `loss_sum_count`

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        const pixel_row<W> p(w, index, width, height);
        real m[5] = {real(0), real(0), real(0), real(0), real(0)};
        p.template blur<true>(w, window, moments, m);

        // S = (2 mx my + C1)(2 cov + C2) / ((mx^2 + my^2 + C1)(vx + vy + C2)), with vx = m[2] - mx^2 and so
        // on.
        constexpr auto C1 = static_cast<Real>(0.01 * 0.01), C2 = static_cast<Real>(0.03 * 0.03);
        const real mean_product = m[0] * m[1], squares = fma(m[0], m[0], m[1] * m[1]);
        const real a1 = mean_product + mean_product + C1, b1 = squares + C1;
        const real covariance = m[4] - mean_product;
        const real a2 = covariance + covariance + C2, b2 = m[2] + m[3] - squares + C2;
        const real inverse = Real(1) / (b1 * b2);
        const real s = a1 * a2 * inverse;
        const real by_square = -s / b2;
        const real by_product = (a1 + a1) * inverse;
        const real by_mean =
            (m[1] + m[1]) * (a2 - a1) * inverse + (m[0] + m[0]) * s * (Real(1) / b2 - Real(1) / b1);
        w.store_row(derivatives[0], p.first, by_mean, p.inside);
        w.store_row(derivatives[1], p.first, by_square, p.inside);
        w.store_row(derivatives[2], p.first, by_product, p.inside);

        const real error = w.load_row(x, p.first, p.inside) - w.load_row(y, p.first, p.inside);
        const value_t<W, double> found[loss_sum_count] = {
            warpagg::math::convert<double>(warpagg::math::max(error, -error)),
            warpagg::math::convert<double>(error * error), warpagg::math::convert<double>(s)};
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
        real sum[3] = {real(0), real(0), real(0)};
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
        real sum[3] = {real(0), real(0), real(0)};
        p.template blur<true>(w, window, spread, sum);
        const real a = w.load_row(x, p.first, p.inside), b = w.load_row(y, p.first, p.inside);
        const real similarity = sum[0] + (a + a) * sum[1] + b * sum[2];
        const Real each = Real(1) / (Real(3) * Real(width) * Real(height));
        const real sign = select(a > b, real(1), select(a < b, real(-1), real(0)));
        const real g = sign * (each * (Real(1) - ssim_weight)) - similarity * (each * ssim_weight);
        w.store_row(gradient, p.first, g, p.inside);
    }
};

}  // namespace gs::train
