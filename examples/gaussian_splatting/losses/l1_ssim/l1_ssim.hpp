// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <type_traits>

#include "../../device/device.hpp"
#include "../loss.hpp"
#include "l1_ssim_passes.hpp"

namespace gs::train {

/// The loss L = (1 - w) mean|x - y| + w (1 - mean SSIM(x, y)) of the render x and the target y,
/// with w = `l1_ssim_weight`. With a mask, the gradient treats masked pixels as black in both
/// images, and divides by the number of all pixels. The reported means do not count masked pixels.
template <device::device Device, class Real>
class l1_ssim final : public loss<Real> {
  public:
    static constexpr std::string_view name = "l1_ssim";

    explicit l1_ssim(Device& device) : passes_(device) {}

    void set_target(const target_image& target) override {
        passes_.set_target(target);
        pixels_ = static_cast<float>(target.width) * static_cast<float>(target.height);
        gradient_.resize(3 * static_cast<std::size_t>(target.width) *
                         static_cast<std::size_t>(target.height));
    }

    const Real* gradient(const Real* render, const raster::list_capacity& capacity) override {
        passes_.run(render, gradient_.data(), capacity);
        return gradient_.data();
    }

    /// The SSIM at a pixel depends on the pixels under its window, and its gradient on the SSIM of all
    /// pixels under a window around it.
    int reach() const override { return 2 * ssim_window<Real>::radius; }

    /// Returns 1 / n for n pixels. The L1 term contributes (1 - w) / (3 n). The SSIM term exceeds
    /// the remainder only in windows with almost no contrast.
    float gradient_scale() const override { return 1.0f / pixels_; }

    std::span<double> sums() const override { return passes_.sums(); }

    loss_report take() override {
        const image_quality mean = passes_.take();
        return {(1 - l1_ssim_weight) * mean.absolute_error + l1_ssim_weight * (1 - mean.ssim),
                mean.square_error};
    }

  private:
    // knob: is_fused
    static constexpr bool is_fused = fused_l1_ssim<Real, false>::template suits<typename Device::warp>;

    std::conditional_t<is_fused, fused_pass<Device, Real>, three_passes<Device, Real>> passes_;
    float pixels_ = 0;
    typename Device::template buffer<Real> gradient_;
};

}  // namespace gs::train
