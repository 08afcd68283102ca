// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../../checkpoint/exchange_buffer.hpp"
#include "../../device/device.hpp"
#include "moving_kernels.hpp"

namespace gs::features {

/// Weights of pixels, small where the residual is an outlier among the residuals of all views. Moving
/// things have such residuals, because other views show the scene without them. Residuals are compared in
/// neighborhoods of about 20 pixels, so that fine details and highlights count. See RobustNeRF (Sabour et
/// al. 2023) and SpotLessSplats (Sabour et al. 2024), whose rules differ.
template <device::device Device>
class residual_weights {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit residual_weights(Device& device) : device_(device) {}

    /// Forgets all residuals. `views`: number of views of which later calls of `measure` remember the
    /// residuals.
    void reset(std::size_t views) {
        keeps_ = 1 - 1 / static_cast<float>(std::max<std::size_t>(views, 2));
        bins_.resize(residual_bins::count);
        counts_.resize(residual_bins::count);
        limit_.resize(1);
        device_.zero(bins_.data(), bins_.size());
        device_.zero(counts_.data(), counts_.size());
        device_.zero(limit_.data(), limit_.size());
    }

    /// Saves or loads the residuals of earlier views. Keeps the present ones if the archive has none.
    void exchange(state_archive& archive) {
        if (archive.loads() && !archive.has("bins")) return;
        exchange_buffer(archive, device_, "bins", bins_);
        if (bins_.size() != residual_bins::count)
            throw error("the checkpoint has residuals of moving things in another form");
    }

    /// Compares a render, three planes, with its target. With several ranks, each has the `own` rows of the
    /// render. A render that exceeds the capacity leaves the residuals of earlier views as they are.
    void measure(const train::target_image& target, const float* render, const row_range& own,
                 const raster::list_capacity& capacity) {
        grid_ = {target.width, target.height};
        const std::size_t cells = grid_.count();
        sums_.resize(2 * cells);
        residuals_.resize(cells);
        float* const pixels = sums_.data() + cells;
        device_.for_each_index(cells, sum_residuals{target, render, own, sums_.data(), pixels});
        device_.sum_over_ranks(sums_.data(), 2 * cells);
        device_.for_each_index(cells, smooth_residuals{sums_.data(), pixels, grid_, capacity,
                                                       residuals_.data(), counts_.data()});
        device_.for_each_index(1,
                               update_limit{capacity, keeps_, counts_.data(), bins_.data(), limit_.data()});
    }

    /// Returns the gradient, three planes, times the weights of the view that was measured last. The result
    /// is valid until the next call.
    const float* weigh(const float* gradient) {
        weighted_.resize(3 * grid_.pixels());
        device_.for_each_index(grid_.pixels(), weigh_gradient{residuals_.data(), grid_, limit_.data(),
                                                              gradient, weighted_.data()});
        return weighted_.data();
    }

    /// Returns the largest residual that counts fully in the view that was measured last. Waits for the
    /// device.
    float limit() const {
        float limit = 0;
        device_.download(&limit, limit_.data(), 1);
        return limit;
    }

  private:
    Device& device_;
    float keeps_ = 0;
    cell_grid grid_{};
    buffer<float> sums_;       ///< of the residuals in each cell, then the number of pixels of each cell
    buffer<float> residuals_;  ///< of the neighborhood of each cell
    buffer<float> bins_, limit_, weighted_;
    buffer<std::uint32_t> counts_;  ///< zero between calls
};

}  // namespace gs::features
