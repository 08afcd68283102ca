// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <warpagg/atomic.hpp>

#include "../../render/geometry/list_capacity.hpp"
#include "../../image/masked_pixel.hpp"
#include "ssim_strip.hpp"

namespace gs::train {

/// What the passes hand on, framed planes each.
template <class Real>
struct loss_maps {
    framed_planes planes;
    Real* sum;            ///< of the picture x and the photo y: x + y
    Real* difference;     ///< x - y
    Real* constant;       ///< of the similarity's derivative by x, what goes with no value under the window,
    Real* by_sum;         ///< what each x + y under the window has to be multiplied with,
    Real* by_difference;  ///< and each x - y

    static constexpr std::size_t count = 5;
    static loss_maps in(Real* memory, const framed_planes& planes) {
        const std::size_t n = planes.size();
        return {planes, memory, memory + n, memory + 2 * n, memory + 3 * n, memory + 4 * n};
    }
};

/// Of a photo with a mask: pixels that it leaves out.
template <class W>
WARPAGG_HD mask_t<W> is_left_out(const W& w, const std::uint32_t* photo, std::ptrdiff_t pixel,
                                 const mask_t<W>& inside) {
    return w.load_row(photo, pixel, inside) == value_t<W, unsigned>(left_out);
}

/// First pass: the sum of and the difference between the picture and the photo over a background, in which
/// the similarity is simplest; and zeros into the frames of all maps and after their end. Pixels that a mask
/// leaves out are zero in both. A warp for as many values of a line as it has lanes.
template <class Real, bool Masked>
struct sum_and_difference {
    const std::uint32_t* photo;  ///< premultiplied RGBA bytes
    const Real* picture;
    glm::vec<3, Real> background;
    loss_maps<Real> maps;

    template <class W>
    static std::size_t count(const framed_planes& planes) {
        return planes.size() / W::size;
    }

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        using warpagg::math::convert;
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
        const mask_t<W> inside = w.lane() < static_cast<unsigned>(planes.width - left);
        if (w.any(!inside)) {
            for (Real* map : derivatives) w.store_row(map, to, zero, !inside);
        }

        const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(row) * planes.width + left;
        const value_t<W, unsigned> rgba = w.load_row(photo, pixel, inside);
        const auto fraction = [&](const value_t<W, unsigned>& byte) {  // byte / 255, rounded once
            constexpr Real unit = Real(1) / 255;
            const real n = convert<Real>(convert<int>(byte)), q = n * unit;
            return fma(fma(q, real(-255), n), real(unit), q);
        };
        // 1 where nothing is, which leaves the background as it is.
        const real through = fraction(255u - (rgba >> value_t<W, unsigned>(24u)));
        const value_t<W, unsigned> shift(8 * static_cast<unsigned>(channel));
        const real y = fraction((rgba >> shift) & 255u) + through * background[channel];
        const auto plane = static_cast<std::ptrdiff_t>(planes.width) * planes.height;
        const real x = w.load_row(picture, channel * plane + pixel, inside);
        mask_t<W> counts = inside;
        if constexpr (Masked) counts = counts && rgba != value_t<W, unsigned>(left_out);
        w.store_row(maps.sum, to, select(counts, x + y, zero), true);
        w.store_row(maps.difference, to, select(counts, x - y, zero), true);
    }
};

/// Where the second pass adds up what it finds over all pixels and channels.
enum loss_sum { sum_absolute, sum_square, sum_ssim, sum_values, loss_sum_count };

/// Second pass: the similarity of each pixel, and its derivatives by the moments of its window. Adds the
/// absolute and square errors, the similarity and the number of values to `totals`: of pixels that no mask
/// leaves out. A warp per strip.
template <class Real, bool Masked>
struct ssim_compare {
    const std::uint32_t* photo;
    loss_maps<Real> maps;
    ssim_window<Real> window;
    int rows;        ///< of a strip
    double* totals;  ///< `loss_sum_count`
    raster::list_room room;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        constexpr int radius = ssim_window<Real>::radius, size = ssim_window<Real>::size;
        const framed_planes& planes = maps.planes;
        const picture_strip<W> strip(w, index, planes.width, planes.height, rows);
        moments<real> sums[size], differences[size];  // of the windows that a row is in
        WARPAGG_UNROLL
        for (int k = 0; k < size; ++k) sums[k] = differences[k] = {real(0), real(0)};
        real absolute(0), square(0), likeness(0);
        [[maybe_unused]] real without(0);
        std::ptrdiff_t at = planes.at(strip.channel, strip.first - radius) + strip.left;
        for (int below = strip.first - radius; below < strip.last + radius; ++below, at += planes.pitch()) {
            const Real* const values[] = {maps.sum + at, maps.difference + at};
            moments<real> along[2];
            window.moments_along(w, values, along);
            window.add_row(sums, along[0]);
            window.add_row(differences, along[1]);
            if (below < strip.first + radius) continue;

            // Wang et al.'s (2 mx my + C1)(2 cov + C2) / ((mx^2 + my^2 + C1)(vx + vy + C2)) in the moments of
            // u = 2 (x + y) and v = 2 (x - y): each factor is within [-1, 1].
            constexpr auto C1 = static_cast<Real>(8 * 0.01 * 0.01), C2 = static_cast<Real>(8 * 0.03 * 0.03);
            const real mu = sums[size - 1].mean, mv = differences[size - 1].mean;
            const real vu = sums[size - 1].square, vv = differences[size - 1].square;
            const real r1 = Real(1) / (fma(mu, mu, mv * mv) + C1), r2 = Real(1) / (vu + vv + C2);
            const real t1 = (mv + mv) * r1, lost1 = mv * t1, like1 = Real(1) - lost1;
            const real lost2 = (vv + vv) * r2, like2 = Real(1) - lost2;
            const real scale = Real(8) * like1 * r2;
            const real by_u = scale * lost2, by_v = scale * (lost2 - Real(2));
            const real by_mean = (t1 + t1) * like2 * (fma(mu, t1, lost1) - Real(2));
            const std::ptrdiff_t pixel = at - radius * planes.pitch();
            w.store_row(maps.constant, pixel, by_mean - Real(0.5) * fma(by_u, mu, by_v * mv), strip.inside);
            w.store_row(maps.by_sum, pixel, by_u, strip.inside);
            w.store_row(maps.by_difference, pixel, by_v, strip.inside);

            const real error = w.load_row(maps.difference, pixel, strip.inside);
            absolute += warpagg::math::max(error, -error);
            square = fma(error, error, square);
            real weight = like2;
            if constexpr (Masked) weight = counted(w, strip, below - radius, weight, without);
            likeness = fma(like1, weight, likeness);
        }
        if (room.exceeded()) return;
        using warpagg::math::convert;
        value_t<W, double> values(static_cast<double>(strip.last - strip.first));
        if constexpr (Masked) values = values - convert<double>(without);
        const value_t<W, double> found[loss_sum_count] = {convert<double>(absolute), convert<double>(square),
                                                          convert<double>(likeness), values};
        warpagg::warp_reduce_atomic(w, totals, found, strip.inside);
    }

  private:
    /// Zero where the row's pixel is left out, which is counted in `without`; else the value.
    template <class W, class real>
    WARPAGG_HD real counted(const W& w, const picture_strip<W>& strip, int row, const real& value,
                            real& without) const {
        const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(row) * maps.planes.width + strip.left;
        const mask_t<W> out = is_left_out(w, photo, pixel, strip.inside);
        without += select(out, real(1), real(0));
        return select(out, real(0), value);
    }
};

/// Last pass: the gradient by x of `(1 - ssim_weight) mean|x - y| + ssim_weight (1 - mean SSIM)`, zero where
/// a mask leaves out a pixel. A warp per strip.
template <class Real, bool Masked>
struct loss_gradient {
    const std::uint32_t* photo;
    loss_maps<Real> maps;
    ssim_window<Real> window;
    int rows;
    Real ssim_weight;
    Real* gradient;  ///< three planes without a frame

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using real = value_t<W, Real>;
        constexpr int radius = ssim_window<Real>::radius, size = ssim_window<Real>::size;
        const framed_planes& planes = maps.planes;
        const picture_strip<W> strip(w, index, planes.width, planes.height, rows);
        const Real each = Real(1) / (Real(3) * Real(planes.width) * Real(planes.height));
        const Real step = each * (Real(1) - ssim_weight), slope = each * ssim_weight;
        real spread[3][size];
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
            window.mean_along(w, derivatives, mean);
            WARPAGG_UNROLL
            for (int m = 0; m < 3; ++m) window.add_row(spread[m], mean[m]);
            if (below < strip.first + radius) continue;

            const std::ptrdiff_t pixel = at - radius * planes.pitch();
            const real u = w.load_row(maps.sum, pixel, strip.inside),
                       v = w.load_row(maps.difference, pixel, strip.inside);
            const real similarity =
                fma(v, spread[2][size - 1], fma(u, spread[1][size - 1], spread[0][size - 1]));
            const real sign = select(v > Real(0), real(step), select(v < Real(0), real(-step), real(0)));
            real by_x = sign - similarity * slope;
            if constexpr (Masked)
                by_x = select(is_left_out(w, photo, to - plane, strip.inside), real(0), by_x);
            w.store_row(gradient, to, by_x, strip.inside);
            to += planes.width;
        }
    }
};

}  // namespace gs::train
