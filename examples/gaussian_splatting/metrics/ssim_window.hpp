// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <warpagg/warp/concept.hpp>

namespace gs::train {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::fma;
using warpagg::math::select;

/// The weighted mean of a group of values, and the weighted sum of their squared deviations from
/// it. This sum is the variance if the weights add up to 1.
template <class V>
struct moments {
    V mean, square;
};

/// The window of the SSIM (Wang et al. 2004): a normalized Gaussian with a standard deviation of
/// 1.5 pixels and 11 taps in each direction. The moments of the values in the window are merged
/// group by group.
template <class Real>
struct ssim_window {
    static constexpr int radius = 5, size = 2 * radius + 1;

    /// The factors that merge a group of weight w with the previous groups of total weight W (Chan
    /// et al. 1979): w, w / (W + w) and w W / (W + w). A variance that is merged in this way is a
    /// sum of squares, so rounding never makes it negative.
    struct step {
        Real weight, share, between;
    };

    Real tap[radius + 1];   ///< taps by distance from the center
    step pair[radius + 1];  ///< from the center outward, two neighbors at a time
    step row[size];         ///< from the first row to the last

    static ssim_window make() {
        double tap[radius + 1], sum = 0;
        for (int i = 0; i <= radius; ++i)
            sum += (i == 0 ? 1 : 2) * (tap[i] = std::exp(-i * i / (2 * 1.5 * 1.5)));
        ssim_window w{};
        double inner = 0, above = 0;
        const auto next = [](double weight, double& before) {
            const double both = before + weight;
            const step s{static_cast<Real>(weight), static_cast<Real>(weight / both),
                         static_cast<Real>(weight * before / both)};
            before = both;
            return s;
        };
        for (double& t : tap) t /= sum;
        for (int i = 0; i <= radius; ++i) {
            w.tap[i] = static_cast<Real>(tap[i]);
            w.pair[i] = next((i == 0 ? 1 : 2) * tap[i], inner);
        }
        for (int i = 0; i < size; ++i) w.row[i] = next(tap[std::abs(i - radius)], above);
        return w;
    }

    template <class V>
    static WARPAGG_HD moments<V> merge(const step& by, const moments<V>& before, const moments<V>& group) {
        const V delta = group.mean - before.mean;
        return {fma(V(by.share), delta, before.mean),
                // mutate: variance_by_difference_1
                fma(V(by.between) * delta, delta, fma(V(by.weight), group.square, before.square))};
    }

    /// Computes the moments along a row of *twice* the values from at(m, -radius) to at(m, radius),
    /// for each of N maps m and for the pixel of each lane. Reads all maps together, so that a GPU
    /// waits for their loads only once.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class V, int N, class At>
    WARPAGG_HD void moments_along(const At& at, moments<V> (&all)[N]) const {
        WARPAGG_UNROLL
        for (int m = 0; m < N; ++m) {
            const V center = at(m, 0);
            all[m] = {center + center, V(0)};  // mutate: variance_by_difference_2
        }
        WARPAGG_UNROLL
        for (int t = 1; t <= radius; ++t) {
            WARPAGG_UNROLL
            for (int m = 0; m < N; ++m) {
                const V left = at(m, -t), right = at(m, t);
                const V apart = right - left;
                // mutate: variance_by_difference_3
                all[m] = merge(pair[t], all[m], {left + right, apart * apart});
            }
        }
    }
    /// Computes the weighted mean of the values from at(m, -radius) to at(m, radius), for each of N
    /// maps m.
    WARPAGG_EXEC_CHECK_DISABLE
    template <class V, int N, class At>
    WARPAGG_HD void mean_along(const At& at, V (&mean)[N]) const {
        WARPAGG_UNROLL
        for (int m = 0; m < N; ++m) mean[m] = at(m, 0) * V(tap[0]);
        WARPAGG_UNROLL
        for (int t = 1; t <= radius; ++t) {
            WARPAGG_UNROLL
            for (int m = 0; m < N; ++m) mean[m] = fma(V(tap[t]), at(m, -t) + at(m, t), mean[m]);
        }
    }

    /// Adds a row to the windows that contain it. Afterward, `windows[k]` contains the last k + 1
    /// rows, so `windows[size - 1]` is complete.
    template <class V>
    WARPAGG_HD void add_row(moments<V> (&windows)[size], const moments<V>& values) const {
        WARPAGG_UNROLL
        for (int k = size - 1; k > 0; --k) windows[k] = merge(row[k], windows[k - 1], values);
        windows[0] = {values.mean, V(row[0].weight) * values.square};  // mutate: variance_by_difference_4
    }
    template <class V>
    WARPAGG_HD void add_row(V (&windows)[size], const V& value) const {
        WARPAGG_UNROLL
        for (int k = size - 1; k > 0; --k) windows[k] = fma(V(row[k].weight), value, windows[k - 1]);
        windows[0] = V(row[0].weight) * value;
    }
};

/// Reads the values of N maps near the pixel of each lane from memory, for `ssim_window`.
template <class W, class Real, int N>
struct map_values {
    const W& w;
    const Real* const (&from)[N];  ///< each map's value at the pixel of lane 0

    WARPAGG_HD value_t<W, Real> operator()(int map, int tap) const { return w.load_row(from[map], tap); }
};

}  // namespace gs::train
