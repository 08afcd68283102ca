// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

#include "../../metrics/comparison_totals.hpp"
#include "../../metrics/lane_columns.hpp"
#include "../../metrics/ssim_strip.hpp"
#include "../../metrics/ssim_terms.hpp"
#include "../../metrics/target_pixels.hpp"
#include "../../render/geometry/list_capacity.hpp"

namespace gs::train {

/// Computes the gradient of `l1_ssim` and adds to its totals in one pass without intermediate maps.
/// The results are those of `sum_and_difference`, `ssim_compare` and `l1_ssim_gradient`, except for
/// the rounding of the totals, and of products and sums that a compiler contracts. One warp per strip
/// of the `own` rows.
///
/// A warp streams down its strip. Each step adds one row of the images to the moments under the
/// windows that contain the row. It computes the coefficients of the derivative of the SSIM for the
/// row 5 pixels above, and the gradient for the row 10 pixels above. All windows are in registers.
/// Windows overlap the neighbors of a strip, so a warp computes coefficients for 5 columns and rows
/// beyond its strip on each side.
template <class Real, bool Masked>
struct fused_l1_ssim {
    const std::uint32_t* target;  ///< premultiplied RGBA bytes
    const Real* render;           ///< three planes
    int width, height;
    Real background[3];
    ssim_window<Real> window;
    row_range own;
    int rows;  ///< rows per strip
    Real ssim_weight;
    Real* gradient;  ///< three planes
    double* totals;  ///< one sum per `comparison_total`
    raster::list_capacity capacity;

    static constexpr int radius = ssim_window<Real>::radius, size = ssim_window<Real>::size;
    /// The number of columns per lane. With two instead of one, a larger part of a warp's columns
    /// belongs to its strip, and neighbors share shuffles. The windows of three would not fit in a
    /// GPU's registers.
    static constexpr int columns = 2;
    static constexpr int warps_at_once = 8;  ///< warps per multiprocessor: at most 255 registers

    /// Whether a strip of the warp is much wider than a window.
    template <class W>
    static constexpr bool suits = W::size >= 32;
    template <class W>
    using strip_of = ssim_strip<W, columns* static_cast<int>(W::size) - 2 * radius>;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        const strip_of<W> strip(w, index, width, own, rows);
        stream<W> s(*this, w, strip);
        for (int row = strip.first - 2 * radius; row < strip.last + 2 * radius; ++row) {
            s.add_images(row);
            if (row < strip.first) continue;
            s.add_derivative(row - radius);
            if (row < strip.first + 2 * radius) continue;
            s.store_gradient(row - 2 * radius);
        }
        if (!capacity.exceeded()) s.add_totals();
    }

  private:
    template <class W>
    class stream;
};

/// A warp on its way down a strip.
template <class Real, bool Masked>
template <class W>
class fused_l1_ssim<Real, Masked>::stream {
    using real = value_t<W, Real>;
    using number = value_t<W, unsigned>;
    using lane_row = lane_columns<W, Real, columns>;
    static constexpr int reach = lane_row::reach;
    static constexpr unsigned strip_columns = columns * W::size - 2 * radius;

    /// A pixel of both images per lane.
    struct pixels {
        real x;
        number rgba;
    };

  public:
    WARPAGG_HD stream(const fused_l1_ssim& pass, const W& w, const strip_of<W>& strip)
        : pass_(pass),
          w_(w),
          strip_(strip),
          plane_(static_cast<std::ptrdiff_t>(strip.channel) * pass.width * pass.height),
          background_(pass.background[strip.channel]) {
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c) {
            WARPAGG_UNROLL
            for (int k = 0; k < size; ++k) {
                sums_[c][k] = differences_[c][k] = {real(0), real(0)};
                WARPAGG_UNROLL
                for (int m = 0; m < 3; ++m) spread_[c][m][k] = real(0);
            }
        }
        load_images(strip.first - 2 * radius);
    }

    /// Adds a row to the moments. Loads the next row meanwhile.
    WARPAGG_HD void add_images(int row) {
        lane_row u, v;
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c)
            sum_and_difference_of(next_[c], is_inside(image_column(c), row), u.at[c], v.at[c]);
        real u_after, v_after;
        sum_and_difference_of(next_after_, is_inside(column_after(), row), u_after, v_after);
        load_images(row + 1);
        real values[2][reach];
        u.under_windows(w_, u_after, values[0]);
        v.under_windows(w_, v_after, values[1]);
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c) {
            moments<real> along[2];
            pass_.window.moments_along(lane_values<real, 2, reach>{values, c}, along);
            pass_.window.add_row(sums_[c], along[0]);
            pass_.window.add_row(differences_[c], along[1]);
        }
    }

    /// Adds the coefficients of a row, whose windows are complete, to those under the windows of the
    /// gradient. Pixels outside of the image have no SSIM.
    WARPAGG_HD void add_derivative(int row) {
        lane_row coefficients[3];
        const bool is_own_row = row >= strip_.first && row < strip_.last;
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c) {
            const auto terms = ssim_terms<real>::of(sums_[c][size - 1], differences_[c][size - 1]);
            const number column = gradient_column(c) - number(radius);
            const mask_t<W> inside = is_inside(column, row);  // mutate: ssim_of_pixels_outside
            coefficients[0].at[c] = select(inside, terms.constant, real(0));
            coefficients[1].at[c] = select(inside, terms.by_sum, real(0));
            coefficients[2].at[c] = select(inside, terms.by_difference, real(0));
            mask_t<W> counts = inside && is_own(column, is_own_row);
            if constexpr (Masked) counts = counts && !is_masked(load(pass_.target, column, row, counts));
            ssim_ += select(counts, terms.factor1 * terms.factor2, real(0));
        }
        real values[3][reach];
        WARPAGG_UNROLL
        for (int m = 0; m < 3; ++m) coefficients[m].under_windows(w_, values[m]);
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c) {
            real mean[3];
            pass_.window.mean_along(lane_values<real, 3, reach>{values, c}, mean);
            WARPAGG_UNROLL
            for (int m = 0; m < 3; ++m) pass_.window.add_row(spread_[c][m], mean[m]);
        }
    }

    /// Stores the gradient of a row, whose windows are complete.
    WARPAGG_HD void store_gradient(int row) {
        const Real each = Real(1) / (Real(3) * Real(pass_.width) * Real(pass_.height));
        const Real step = each * (Real(1) - pass_.ssim_weight), slope = each * pass_.ssim_weight;
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c) {
            const number column = gradient_column(c);
            const mask_t<W> own = is_inside(column, row) && is_own(column, true);
            const pixels p = {load(pass_.render + plane_, column, row, own),
                              load(pass_.target, column, row, own)};
            real u, v;
            sum_and_difference_of(p, own, u, v);
            const real by_ssim =
                fma(v, spread_[c][2][size - 1], fma(u, spread_[c][1][size - 1], spread_[c][0][size - 1]));
            const real sign = select(v > Real(0), real(step), select(v < Real(0), real(-step), real(0)));
            real by_x = sign - by_ssim * slope;
            if constexpr (Masked) by_x = select(is_masked(p.rgba), real(0), by_x);
            w_.store(pass_.gradient + plane_, index_of(column, row), by_x, own);
            absolute_ += warpagg::math::max(v, -v);
            square_ = fma(v, v, square_);
            mask_t<W> counts = own;
            if constexpr (Masked) counts = counts && !is_masked(p.rgba);
            values_ += select(counts, real(1), real(0));
        }
    }

    WARPAGG_HD void add_totals() const {
        using warpagg::math::convert;
        const value_t<W, double> found[comparison_total_count] = {
            convert<double>(absolute_), convert<double>(square_), convert<double>(ssim_),
            convert<double>(values_)};
        warpagg::warp_reduce_atomic(w_, pass_.totals, found, mask_t<W>(true));
    }

  private:
    /// The columns of a lane in the gradient and in the images, and the column behind those of the
    /// last lane. Columns to the left of the image wrap around to large numbers.
    /// @{
    WARPAGG_HD number gradient_column(int c) const {
        return w_.lane() * number(columns) + number(static_cast<unsigned>(strip_.left + c));
    }
    WARPAGG_HD number image_column(int c) const { return gradient_column(c) - number(2 * radius); }
    WARPAGG_HD number column_after() const {
        return w_.lane() + number(static_cast<unsigned>(strip_.left) + strip_columns);
    }
    /// @}
    WARPAGG_HD mask_t<W> is_inside(const number& column, int row) const {
        return column < number(static_cast<unsigned>(row >= 0 && row < pass_.height ? pass_.width : 0));
    }
    WARPAGG_HD mask_t<W> is_own(const number& column, bool is_own_row) const {
        return column - number(static_cast<unsigned>(strip_.left)) < number(is_own_row ? strip_columns : 0u);
    }
    static WARPAGG_HD mask_t<W> is_masked(const number& rgba) { return rgba == number(masked_pixel); }
    WARPAGG_HD number index_of(const number& column, int row) const {
        return column + number(static_cast<unsigned>(row * pass_.width));
    }
    template <class T>
    WARPAGG_HD value_t<W, T> load(const T* plane, const number& column, int row,
                                  const mask_t<W>& active) const {
        return w_.load(plane, index_of(column, row), active);
    }

    WARPAGG_HD pixels load_pixels(const number& column, int row) const {
        const mask_t<W> inside = is_inside(column, row);
        return {load(pass_.render + plane_, column, row, inside), load(pass_.target, column, row, inside)};
    }
    WARPAGG_HD void load_images(int row) {
        WARPAGG_UNROLL
        for (int c = 0; c < columns; ++c) next_[c] = load_pixels(image_column(c), row);
        next_after_ = load_pixels(column_after(), row);
    }
    /// Computes u = x + y and v = x - y, which are zero outside of the image and at masked pixels.
    WARPAGG_HD void sum_and_difference_of(const pixels& p, mask_t<W> inside, real& u, real& v) const {
        if constexpr (Masked) inside = inside && !is_masked(p.rgba);
        const real y = target_value<W>(p.rgba, strip_.channel, background_);
        u = select(inside, p.x + y, real(0));
        v = select(inside, p.x - y, real(0));
    }

    const fused_l1_ssim& pass_;
    const W& w_;
    const strip_of<W>& strip_;
    const std::ptrdiff_t plane_;  ///< index of the channel's first value
    const Real background_;
    pixels next_[columns], next_after_;  ///< the next row
    moments<real> sums_[columns][size], differences_[columns][size];
    real spread_[columns][3][size];  ///< the coefficients under the windows of the gradient
    real absolute_{0}, square_{0}, ssim_{0}, values_{0};
};

}  // namespace gs::train
