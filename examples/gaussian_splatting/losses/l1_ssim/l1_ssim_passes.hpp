// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Two ways to compute `l1_ssim` and its gradient on a device. `fused_pass` needs no memory for
/// intermediate results, and a GPU waits less for memory. `three_passes` suits any warp, and CPUs,
/// whose registers cannot hold the windows of `fused_l1_ssim`.

#include <bit>
#include <span>

#include "../../device/device.hpp"
#include "../../metrics/image_comparison.hpp"
#include "fused_l1_ssim.hpp"
#include "l1_ssim_kernels.hpp"

namespace gs::train {

/// The weight of the SSIM in the loss (Kerbl et al. 2023).
inline constexpr double l1_ssim_weight = 0.2;

/// Compares the images by `image_comparison`, and computes the gradient from its maps.
template <device::device Device, class Real>
class three_passes {
  public:
    explicit three_passes(Device& device) : device_(device), comparison_(device) {}

    void set_target(const target_image& target) { comparison_.set_target(target); }
    void run(const Real* render, Real* gradient, const raster::list_capacity& capacity) {
        comparison_.compare(render, capacity);  // knob: compare
        comparison_.is_masked() ? differentiate<true>(gradient) : differentiate<false>(gradient);
    }
    std::span<double> sums() const { return comparison_.totals(); }
    image_quality take() { return comparison_.take(); }

  private:
    template <bool Masked>
    void differentiate(Real* gradient) {
        const row_range own = comparison_.compared_rows();
        device_.for_each_warp(comparison_.strips(own),
                              l1_ssim_gradient<Real, Masked>{
                                  comparison_.target(), comparison_.maps(), comparison_.window(), own,
                                  // knob: loss_weight
                                  comparison_.rows(), static_cast<Real>(l1_ssim_weight), gradient});
    }

    Device& device_;
    image_comparison<Device, Real> comparison_;  // knob: loss_members
};

/// Runs `fused_l1_ssim`.
template <device::device Device, class Real>
class fused_pass {
  public:
    explicit fused_pass(Device& device) : device_(device), totals_(device) {}

    void set_target(const target_image& target) {
        static_assert(std::endian::native == std::endian::little);
        target_ = target;
    }
    void run(const Real* render, Real* gradient, const raster::list_capacity& capacity) {
        target_.masked ? run_kernel<true>(render, gradient, capacity)
                       : run_kernel<false>(render, gradient, capacity);
    }
    std::span<double> sums() const { return totals_.sums(); }
    image_quality take() { return totals_.take(); }

  private:
    template <bool Masked>
    void run_kernel(const Real* render, Real* gradient, const raster::list_capacity& capacity) {
        using kernel = fused_l1_ssim<Real, Masked>;
        using strip = typename kernel::template strip_of<typename Device::warp>;
        const int width = target_.width, height = target_.height;
        const auto& [red, green, blue] = target_.background;
        const row_range own = target_.compared_rows();
        const int rows = strip::rows_for(width, own.count(), device_.resident_warps() / 4);
        device_.for_each_warp(strip::count(width, own, rows),
                              kernel{reinterpret_cast<const std::uint32_t*>(target_.rgba),
                                     render,
                                     width,
                                     height,
                                     {red, green, blue},
                                     window_,
                                     own,
                                     rows,
                                     static_cast<Real>(l1_ssim_weight),
                                     gradient,
                                     totals_.data(),
                                     capacity});
    }

    Device& device_;
    ssim_window<Real> window_ = ssim_window<Real>::make();
    target_image target_;
    comparison_totals<Device> totals_;
};

}  // namespace gs::train
