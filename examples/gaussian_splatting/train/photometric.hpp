// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "loss.hpp"
#include "quality.hpp"

namespace gs::train {

/// Compares pictures with photos: the loss, its gradient, and the measures of quality.
template <class Device, class Real>
class photometric {
  public:
    template <class T>
    using buffer = typename Device::template buffer<T>;

    explicit photometric(Device& device) : device_(device) {
        totals_.resize(loss_sum_count);
        device_.zero(totals_.data(), loss_sum_count);
    }

    /// The photo, premultiplied RGBA on the device, over a background: what pictures are compared with next.
    void set_photo(const std::uint8_t* rgba, int width, int height, const std::array<float, 3>& background) {
        width_ = width;
        height_ = height;
        const std::size_t n = pixels();
        photo_.resize(3 * n);
        device_.for_each_index(
            n, composite<Real>{rgba, {background[0], background[1], background[2]}, n, photo_.data()});
    }

    /// Adds the picture's measures to the running ones, if there was room for all of it. The first half of
    /// `gradient`.
    void compare(const Real* picture, const raster::list_room& room = {}) {
        const std::size_t n = 3 * pixels();
        for (auto& m : moments_) m.resize(n);
        for (auto& d : derivatives_) d.resize(n);
        ssim_moments<Real> across{picture, photo_.data(), width_, height_, window_, {}};
        ssim_compare<Real> down{picture, photo_.data(),  width_, height_, window_, {},
                                {},      totals_.data(), room};
        for (std::size_t i = 0; i < ssim_moment_count; ++i)
            down.moments[i] = across.moments[i] = moments_[i].data();
        for (std::size_t i = 0; i < 3; ++i) down.derivatives[i] = derivatives_[i].data();
        device_.for_each_warp(rows(), across);
        device_.for_each_warp(rows(), down);
    }

    /// dL/dpicture for L = (1 - ssim_weight) L1 + ssim_weight (1 - SSIM), on the device. Compares as well.
    const Real* gradient(const Real* picture, double ssim_weight, const raster::list_room& room = {}) {
        compare(picture, room);
        ssim_spread<Real> spread{width_, height_, window_, {}, {}};
        loss_gradient<Real> last{
            picture, photo_.data(), width_, height_, window_, {}, static_cast<Real>(ssim_weight), nullptr};
        gradient_.resize(3 * pixels());
        last.gradient = gradient_.data();
        for (std::size_t i = 0; i < 3; ++i) {
            spread.derivatives[i] = derivatives_[i].data();
            spread.spread[i] = moments_[i].data();  // no longer needed as what they were
            last.spread[i] = moments_[i].data();
        }
        device_.for_each_warp(rows(), spread);
        device_.for_each_warp(rows(), last);
        return gradient_.data();
    }

    /// On the device: what `take` takes, `loss_sum_count` sums.
    const double* totals() const { return totals_.data(); }
    /// The means over all pictures compared since the last call. Waits for the device.
    quality take() {
        double totals[loss_sum_count];
        device_.download(totals, totals_.data(), loss_sum_count);
        device_.zero(totals_.data(), loss_sum_count);
        const double n = totals[sum_values];
        return {totals[sum_absolute] / n, totals[sum_square] / n, totals[sum_ssim] / n};
    }

  private:
    std::size_t pixels() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    std::size_t rows() const { return pixel_row<typename Device::warp>::count(width_, height_); }

    Device& device_;
    ssim_window window_ = ssim_window::make();
    int width_ = 0, height_ = 0;
    buffer<Real> photo_, gradient_;
    std::array<buffer<Real>, ssim_moment_count> moments_;
    std::array<buffer<Real>, 3> derivatives_;
    buffer<double> totals_;
};

}  // namespace gs::train
