// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "../../device/device.hpp"
#include "../../metrics/image_comparison.hpp"
#include "../loss.hpp"
#include "l1_ssim_kernels.hpp"

namespace gs::train {

/// The weight of the SSIM in the loss (Kerbl et al. 2023).
inline constexpr double l1_ssim_weight = 0.2;

/// The loss L = (1 - w) mean|x - y| + w (1 - mean SSIM(x, y)) of the render x and the target y,
/// with w = `l1_ssim_weight`. With a mask, the gradient treats masked pixels as black in both
/// images, and divides by the number of all pixels. The reported means do not count masked pixels.
template <device::device Device, class Real>
class l1_ssim final : public loss<Real> {
  public:
    static constexpr std::string_view name = "l1_ssim";

    explicit l1_ssim(Device& device) : device_(device), comparison_(device) {}

    void set_target(const target_image& target) override {
        comparison_.set_target(target);
        pixels_ = static_cast<float>(target.width) * static_cast<float>(target.height);
        gradient_.resize(3 * static_cast<std::size_t>(target.width) *
                         static_cast<std::size_t>(target.height));
    }

    const Real* gradient(const Real* render, const raster::list_capacity& capacity) override {
        comparison_.compare(render, capacity);  // knob: compare
        comparison_.is_masked() ? differentiate<true>() : differentiate<false>();
        return gradient_.data();
    }

    /// Returns 1 / n for n pixels. The L1 term contributes (1 - w) / (3 n). The SSIM term exceeds
    /// the remainder only in windows with almost no contrast.
    float gradient_scale() const override { return 1.0f / pixels_; }

    std::span<const double> sums() const override { return comparison_.totals(); }

    loss_report take() override {
        const image_quality mean = comparison_.take();
        return {(1 - l1_ssim_weight) * mean.absolute_error + l1_ssim_weight * (1 - mean.ssim),
                mean.square_error};
    }

  private:
    template <bool Masked>
    void differentiate() {
        device_.for_each_warp(comparison_.strips(),
                              l1_ssim_gradient<Real, Masked>{
                                  comparison_.target(), comparison_.maps(), comparison_.window(),
                                  // knob: loss_weight
                                  comparison_.rows(), static_cast<Real>(l1_ssim_weight), gradient_.data()});
    }

    Device& device_;
    image_comparison<Device, Real> comparison_;
    float pixels_ = 0;  // knob: loss_members
    typename Device::template buffer<Real> gradient_;
};

}  // namespace gs::train
