// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <warpagg/atomic.hpp>

#include "../../device/atomic.hpp"
#include "../../metrics/target_image.hpp"
#include "../../metrics/target_pixels.hpp"
#include "../../render/geometry/list_capacity.hpp"
#include "../../render/geometry/splat.hpp"

namespace gs::features {

/// Divides an image into square cells, row by row. The strips of ranks consist of whole cells.
struct cell_grid {
    static constexpr int side = 8;  ///< in pixels; cells at the right and at the bottom may be smaller
    static_assert(raster::tile_size % side == 0);

    int width, height;  ///< of the image

    WARPAGG_HD int across() const { return (width + side - 1) / side; }
    WARPAGG_HD int down() const { return (height + side - 1) / side; }
    WARPAGG_HD std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    std::size_t count() const {
        return static_cast<std::size_t>(across()) * static_cast<std::size_t>(down());
    }
    WARPAGG_HD std::size_t cell_of(std::size_t pixel) const {
        const auto row = static_cast<int>(pixel / static_cast<std::size_t>(width)),
                   column = static_cast<int>(pixel % static_cast<std::size_t>(width));
        return static_cast<std::size_t>(row / side * across() + column / side);
    }
};

/// The distribution of residuals: the number of cells in each bin. Bins have equal widths in the
/// square root of the residual, so that small residuals are distinguished better.
struct residual_bins {
    static constexpr unsigned count = 128;

    static WARPAGG_HD unsigned bin_of(float residual) {
        const float root = warpagg::math::sqrt(warpagg::math::min(residual, 1.0f));
        return warpagg::math::min(static_cast<unsigned>(root * count), count - 1);
    }
    /// Returns the largest residual of a bin.
    static WARPAGG_HD float end_of(unsigned bin) {
        const float root = static_cast<float>(bin + 1) / count;
        return root * root;
    }
    /// Returns the residual below which the given share of the cells lies, rounded up to the end of a
    /// bin, and 0 if there are no cells.
    template <class Number>
    static WARPAGG_HD float quantile(const Number* bins, float share) {
        float total = 0, below = 0;
        for (unsigned b = 0; b < count; ++b) total += static_cast<float>(bins[b]);
        if (total == 0) return 0;
        unsigned b = 0;
        for (; b + 1 < count; ++b) {
            below += static_cast<float>(bins[b]);
            if (below >= share * total) break;
        }
        return end_of(b);
    }
};

/// Sums the residuals of the pixels of each cell, in the `own` rows. A residual is the mean over the
/// channels of the absolute difference between the render, clamped to [0, 1], and the target. Pixels that
/// are masked or not finite do not count. One index per cell.
struct sum_residuals {
    const std::uint32_t* rgba;  ///< see `target_image`
    cell_grid grid;
    float background[3];
    const float* shown;  ///< the render, three planes
    row_range own;
    float* sums;    ///< per cell
    float* pixels;  ///< per cell, number of pixels that count

    sum_residuals(const train::target_image& target, const float* render, const row_range& rows,
                  float* sums_of_cells, float* pixels_of_cells)
        : rgba(reinterpret_cast<const std::uint32_t*>(target.rgba)),
          grid{target.width, target.height},
          background{target.background[0], target.background[1], target.background[2]},
          shown(render),
          own(rows),
          sums(sums_of_cells),
          pixels(pixels_of_cells) {}

    WARPAGG_HD void operator()(std::size_t cell) const {
        const int left = static_cast<int>(cell) % grid.across() * cell_grid::side,
                  top = static_cast<int>(cell) / grid.across() * cell_grid::side;
        const row_range rows{
            top > own.first ? top : own.first,
            warpagg::math::min(top + cell_grid::side, warpagg::math::min(own.last, grid.height))};
        const int right = warpagg::math::min(left + cell_grid::side, grid.width);
        float sum = 0, n = 0;
        for (int row = rows.first; row < rows.last; ++row)
            for (int column = left; column < right; ++column) {
                const float error =
                    residual(static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                             static_cast<std::size_t>(column));
                if (!(error >= 0)) continue;
                sum += error;
                n += 1;
            }
        sums[cell] = sum;
        pixels[cell] = n;
    }

  private:
    /// Returns the residual of a pixel, or a negative number if it is masked.
    WARPAGG_HD float residual(std::size_t i) const {
        if (rgba[i] == masked_pixel) return -1;
        float sum = 0;
        for (int c = 0; c < 3; ++c) {
            const float x = shown[static_cast<std::size_t>(c) * grid.pixels() + i];
            const float value = warpagg::math::min(warpagg::math::max(x, 0.0f), 1.0f);
            sum += glm::abs(value -
                            train::target_value<warpagg::emulator::serial, float>(rgba[i], c, background[c]));
        }
        return sum / 3;
    }
};

/// Computes the mean residual in the neighborhood of each cell: the cell counts four times, its
/// neighbors twice, and the diagonal ones once. Counts the neighborhoods by residual, unless the render is
/// incomplete. One index per cell.
struct smooth_residuals {
    const float* sums;
    const float* pixels;
    cell_grid grid;
    raster::list_capacity capacity;
    float* residuals;       ///< per cell; 0 if no pixel of the neighborhood counts
    std::uint32_t* counts;  ///< `residual_bins`

    WARPAGG_HD void operator()(std::size_t cell) const {
        const int column = static_cast<int>(cell) % grid.across(),
                  row = static_cast<int>(cell) / grid.across();
        float sum = 0, n = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const int x = column + dx, y = row + dy;
                if (x < 0 || y < 0 || x >= grid.across() || y >= grid.down()) continue;
                const auto neighbor = static_cast<std::size_t>(y * grid.across() + x);
                const auto weight = static_cast<float>((dx == 0 ? 2 : 1) * (dy == 0 ? 2 : 1));
                sum += weight * sums[neighbor];
                n += weight * pixels[neighbor];
            }
        const float mean = n > 0 ? sum / n : 0;
        residuals[cell] = mean;
        if (pixels[cell] > 0 && mean >= 0 && !capacity.exceeded())
            device::atomic_add(counts + residual_bins::bin_of(mean), 1u);
    }
};

/// Adds the neighborhoods of a view to those of the earlier views, of which it forgets a share, and
/// derives the limit: the residual up to which the view's pixels count fully. The limit is a multiple of a
/// quantile over all views. It is not smaller than the median of the view, so that at least half of each
/// photo counts, and not smaller than a difference that is hardly visible. Sets `counts` to zero. Changes
/// nothing else if the render is incomplete. A single index.
struct update_limit {
    static constexpr float share = 0.8f;          ///< of the neighborhoods that are assumed to be static
    static constexpr float factor = 3;            ///< limit relative to the quantile of that share
    static constexpr float least = 0.04f;         ///< smallest limit
    static constexpr float share_of_view = 0.5f;  ///< of each view that counts fully

    raster::list_capacity capacity;
    float keeps;            ///< share of the earlier views that remains
    std::uint32_t* counts;  ///< `residual_bins` of the view
    float* bins;            ///< `residual_bins` of all views
    float* limit;

    WARPAGG_HD void operator()(std::size_t) const {
        if (!capacity.exceeded()) {
            for (unsigned b = 0; b < residual_bins::count; ++b)
                bins[b] = keeps * bins[b] + static_cast<float>(counts[b]);
            const float usual = factor * residual_bins::quantile(bins, share);
            const float of_view = residual_bins::quantile(counts, share_of_view);
            *limit = warpagg::math::max(float{least}, warpagg::math::max(usual, of_view));
        }
        for (unsigned b = 0; b < residual_bins::count; ++b) counts[b] = 0;
    }
};

/// Multiplies the gradient of the loss by the weights of the pixels. The weight falls from 1 at the limit
/// to that of an outlier at twice the limit. An outlier keeps a small weight: Adam divides gradients by
/// their size, so Gaussians that only outliers show still learn, and the others follow the other views.
/// One index per pixel.
struct weigh_gradient {
    static constexpr float of_outlier = 0.02f;

    const float* residuals;  ///< per cell, of the neighborhood
    cell_grid grid;
    const float* limit;
    const float* gradient;  ///< three planes
    float* weighted;        ///< three planes

    WARPAGG_HD void operator()(std::size_t i) const {
        const float excess = residuals[grid.cell_of(i)] / *limit - 1;
        const float part = warpagg::math::min(warpagg::math::max(excess, 0.0f), 1.0f);
        const float weight = 1 - (1 - of_outlier) * part;
        const std::size_t plane = grid.pixels();
        for (std::size_t c = 0; c < 3; ++c) weighted[c * plane + i] = weight * gradient[c * plane + i];
    }
};

}  // namespace gs::features
