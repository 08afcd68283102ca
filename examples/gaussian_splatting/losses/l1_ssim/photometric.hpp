// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>

#include "../../device/device.hpp"
#include "l1_ssim_kernels.hpp"
#include "quality.hpp"

namespace gs::train {

/// Compares pictures with photos: the loss, its gradient, and the measures of quality.
template <device::device Device, class Real>
class photometric {
    using warp = typename Device::warp;
    using strip = picture_strip<warp>;

  public:
    template <class T>
    using buffer = typename Device::template buffer<T>;

    explicit photometric(Device& device) : device_(device) {
        totals_.resize(loss_sum_count);
        device_.zero(totals_.data(), loss_sum_count);
    }

    /// The photo over a background that pictures are compared with next: premultiplied RGBA on the device, 4
    /// bytes a pixel, aligned to 4, which must stay there meanwhile. `masked`: some of its pixels are left
    /// out.
    void set_photo(const std::uint8_t* rgba, int width, int height, const std::array<float, 3>& background,
                   bool masked = false) {
        static_assert(std::endian::native == std::endian::little);
        photo_ = reinterpret_cast<const std::uint32_t*>(rgba);
        background_ = {background[0], background[1], background[2]};
        masked_ = masked;
        const framed_planes planes{width, height};
        memory_.resize(loss_maps<Real>::count * planes.size());
        maps_ = loss_maps<Real>::in(memory_.data(), planes);
        gradient_.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    }

    /// Adds the picture's measures to the running ones, if there was room for all of it. The first part of
    /// `gradient`.
    void compare(const Real* picture, const raster::list_room& room = {}) {
        masked_ ? compare_with<true>(picture, room) : compare_with<false>(picture, room);
    }

    /// dL/dpicture for L = (1 - ssim_weight) L1 + ssim_weight (1 - SSIM), on the device. Compares as well.
    /// With a mask, of picture and photo that are black where it leaves out, by all pixels.
    const Real* gradient(const Real* picture, double ssim_weight, const raster::list_room& room = {}) {
        compare(picture, room);
        masked_ ? differentiate<true>(ssim_weight) : differentiate<false>(ssim_weight);
        return gradient_.data();
    }

    /// The magnitude that `gradient` has at a pixel, about: the mean of a loss near one.
    float largest_gradient() const {
        return 1.0f / (static_cast<float>(maps_.planes.width) * static_cast<float>(maps_.planes.height));
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
    template <bool Masked>
    void compare_with(const Real* picture, const raster::list_room& room) {
        using first_pass = sum_and_difference<Real, Masked>;
        device_.for_each_warp(first_pass::template count<warp>(maps_.planes),
                              first_pass{photo_, picture, background_, maps_});
        device_.for_each_warp(
            strips(), ssim_compare<Real, Masked>{photo_, maps_, window_, rows(), totals_.data(), room});
    }
    template <bool Masked>
    void differentiate(double ssim_weight) {
        device_.for_each_warp(strips(),
                              loss_gradient<Real, Masked>{photo_, maps_, window_, rows(),
                                                          static_cast<Real>(ssim_weight), gradient_.data()});
    }

    int rows() const {
        return strip::rows_for(maps_.planes.width, maps_.planes.height, device_.resident_warps() / 4);
    }
    std::size_t strips() const { return strip::count(maps_.planes.width, maps_.planes.height, rows()); }

    Device& device_;
    ssim_window<Real> window_ = ssim_window<Real>::make();
    const std::uint32_t* photo_ = nullptr;
    glm::vec<3, Real> background_{};
    bool masked_ = false;
    loss_maps<Real> maps_{};
    buffer<Real> memory_, gradient_;
    buffer<double> totals_;
};

}  // namespace gs::train
