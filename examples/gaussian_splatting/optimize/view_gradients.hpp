// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "../device/device.hpp"
#include "../model/parameter_memory.hpp"
#include "../render/geometry/list_capacity.hpp"
#include "../render/project/gaussian_row.hpp"
#include "trained_parameters.hpp"

namespace gs::train {

/// A sink of `raster::project_backward` that adds the gradients of several views.
struct add_gradients {
    parameter_arrays<float> sums;
    std::uint32_t* took_part;  ///< 1 for each Gaussian that took part in a view
    raster::list_capacity capacity;

    static constexpr bool takes_zeros = false;
    WARPAGG_HD bool idle() const { return capacity.exceeded(); }

    template <class W>
    struct row_sink {
        const add_gradients& to;
        const W& w;
        const raster::gaussian_row<W>& row;

        template <int N, class V>
        WARPAGG_HD void operator()(parameter p, std::size_t k, std::size_t width, const glm::vec<N, V>&,
                                   const glm::vec<N, V>& gradient) const {
            const auto before = row.template load<N>(w, to.sums[p], k, width);
            WARPAGG_UNROLL
            for (int n = 0; n < N; ++n)
                row.store(w, to.sums[p], k, n, width, before[n] + gradient[n], before[n], mask_t<W>(true));
        }
    };
    template <class W>
    WARPAGG_HD row_sink<W> for_row(const W& w, const raster::gaussian_row<W>& row) const {
        w.store_row(took_part, static_cast<std::ptrdiff_t>(row.first), value_t<W, std::uint32_t>(1u),
                    row.active);
        return {*this, w, row};
    }
};

/// Takes a step of Adam with the sums of `add_gradients`, and sets them to zero. One Gaussian per lane.
template <class W, class Adam>
struct step_with_sums {
    using number = value_t<W, std::uint32_t>;

    Adam step;
    add_gradients from;
    std::size_t count;
    int learned_sh_degree;  ///< largest SH degree with gradients

    WARPAGG_HD void operator()(const W& w, unsigned warp_index) const {
        if (from.idle()) return;
        const number i = w.lane() + warp_index * W::size;
        raster::gaussian_row<W> row{std::size_t{warp_index} * W::size,
                                    i < number(static_cast<std::uint32_t>(count)), false};
        const auto first = static_cast<std::ptrdiff_t>(row.first);
        row.active = w.load_row(from.took_part, first, row.inside) != number(0u);
        if (!w.any(row.active)) return;
        w.store_row(from.took_part, first, number(0u), row.active);
        const auto put = step.for_row(w, row);
        take<3>(w, row, put, parameter::mean, 0, 3);
        take<3>(w, row, put, parameter::log_scale, 0, 3);
        take<4>(w, row, put, parameter::quaternion, 0, 4);
        take<1>(w, row, put, parameter::opacity, 0, 1);
        const int degree = row.degree_of(step.values, learned_sh_degree);
        for (int band = 0; band <= degree; ++band)
            for (int m = 0; m < 2 * band + 1; ++m)
                take<3>(w, row, put, sh_band(band), static_cast<std::size_t>(3 * m),
                        static_cast<std::size_t>(3 * (2 * band + 1)));
    }

  private:
    template <int N, class Put>
    WARPAGG_HD void take(const W& w, const raster::gaussian_row<W>& row, const Put& put, parameter p,
                         std::size_t k, std::size_t width) const {
        const raster::row_place<W> at(row, p, row.cache_slot(step.values));
        const auto value = at.row.template load<N>(w, at.array(step.values), k, width);
        const auto sum = row.template load<N>(w, from.sums[p], k, width);
        put(p, k, width, value, sum);
        WARPAGG_UNROLL
        for (int n = 0; n < N; ++n)
            row.store(w, from.sums[p], k, n, width, value_t<W, float>(0.0f), sum[n], mask_t<W>(true));
    }
};

/// The sums of the gradients of all views of a step, for the Gaussians of this rank.
template <device::device Device>
class view_gradients {
    using narrow = typename Device::narrow_warp;

  public:
    explicit view_gradients(Device& device) : device_(device) {}

    /// Returns a sink that adds to the sums, which are zero at first. `capacity`: that of the step's tile
    /// lists. If these do not fit, all gradients are ignored.
    add_gradients begin(trained_parameters<Device>& trained, std::size_t count, int sh_degree,
                        const raster::list_capacity& capacity) {
        const ranks::share own = trained.own(device_, count);
        const std::size_t with_sh = trained.values.gaussians_with_sh();
        if (own != own_ || took_part_.size() != own.count() || !sums_.fits(count, sh_degree) ||
            sums_.gaussians_with_sh() != with_sh) {
            own_ = own;
            sums_.set_division(own);
            sums_.resize(count, with_sh, sh_degree);
            sums_.zero(device_);
            took_part_.resize(own.count());
            device_.zero(took_part_.data(), own.count());
        }
        count_ = count;
        return {sums_.write(), took_part_.data() - own.first, capacity};
    }
    /// Takes a step of Adam with the sums of this sink.
    template <class Adam>
    void step(const Adam& descent, const add_gradients& sums, int learned_sh_degree) {
        if (own_.count() == 0) return;
        device_.template for_each_warp<narrow>(
            ranks::share{own_.first / narrow::size, (own_.last + narrow::size - 1) / narrow::size},
            step_with_sums<narrow, Adam>{descent, sums, count_, learned_sh_degree});
    }
    /// The size of the memory for a Gaussian.
    static constexpr std::size_t bytes_per_gaussian(int sh_degree) {
        std::size_t floats = 0;
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (has_parameter(p, sh_degree)) floats += width_of(static_cast<parameter>(p));
        return floats * sizeof(float) + sizeof(std::uint32_t);
    }

  private:
    Device& device_;
    parameter_memory<Device> sums_;
    typename Device::template buffer<std::uint32_t> took_part_;
    ranks::share own_;
    std::size_t count_ = 0;
};

}  // namespace gs::train
