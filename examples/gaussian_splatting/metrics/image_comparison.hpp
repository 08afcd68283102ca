// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <span>

#include "../device/device.hpp"
#include "comparison_kernels.hpp"
#include "comparison_totals.hpp"
#include "target_image.hpp"

namespace gs::train {

/// Compares renders with their targets on a device. It is the source of the PSNR and SSIM of
/// held-out views, independent of the training loss.
template <device::device Device, class Real>
class image_comparison {
    using strip = ssim_strip<typename Device::warp>;

  public:
    template <class T>
    using buffer = typename Device::template buffer<T>;

    explicit image_comparison(Device& device) : device_(device), totals_(device) {}

    /// Returns the size of the maps of a pixel.
    static constexpr std::size_t bytes_per_pixel() { return comparison_maps<Real>::count * sizeof(Real); }

    /// Sets the target of the next comparisons.
    void set_target(const target_image& target) {
        static_assert(std::endian::native == std::endian::little);
        target_ = target;
        const framed_planes planes{target.width, target.height};
        memory_.resize(comparison_maps<Real>::count * planes.size());
        maps_ = comparison_maps<Real>::in(memory_.data(), planes);
    }

    /// Compares the target's `compared_rows` of a render, three planes on the device. Adds the result
    /// to the totals unless the tile lists of the view did not fit. Masked pixels do not count.
    void compare(const Real* render, const raster::list_capacity& capacity = {}) {  // knob: compare_image
        // knob: compare_masked
        target_.masked ? compare_with<true>(render, capacity) : compare_with<false>(render, capacity);
    }

    /// Returns the totals since the last `take`, on the device: one sum per `comparison_total`.
    std::span<double> totals() const { return totals_.sums(); }
    /// Returns the means over all renders since the last call, and sets the totals to zero. Waits
    /// for the device.
    image_quality take() { return totals_.take(); }

    /// The results of the last `compare` that a gradient of the SSIM needs.
    /// @{
    const comparison_maps<Real>& maps() const { return maps_; }
    const ssim_window<Real>& window() const { return window_; }
    const std::uint32_t* target() const { return reinterpret_cast<const std::uint32_t*>(target_.rgba); }
    bool is_masked() const { return target_.masked; }
    row_range compared_rows() const { return target_.compared_rows(); }
    /// @}

    /// The number of rows per `ssim_strip`, which is chosen to keep the device busy, and the number of
    /// strips that cover some rows.
    /// @{
    int rows() const {
        return strip::rows_for(target_.width, compared_rows().count(), device_.resident_warps() / 4);
    }
    std::size_t strips(const row_range& within) const { return strip::count(target_.width, within, rows()); }
    /// @}

  private:
    template <bool Masked>
    void compare_with(const Real* render, const raster::list_capacity& capacity) {  // knob: compare_with
        using first_pass = sum_and_difference<Real, Masked>;
        using second_pass = ssim_compare<Real, Masked>;
        const auto& [red, green, blue] = target_.background;
        const row_range own = compared_rows();
        device_.for_each_warp(first_pass::template count<typename Device::warp>(maps_.planes),
                              first_pass{target(), render, {red, green, blue}, maps_, own});
        device_.for_each_warp(strips(second_pass::strip_rows(own, target_.height)),
                              // knob: ssim_compare
                              second_pass{target(), maps_, window_, own, rows(), totals_.data(), capacity});
    }

    Device& device_;
    ssim_window<Real> window_ = ssim_window<Real>::make();
    target_image target_;
    comparison_maps<Real> maps_{};
    buffer<Real> memory_;
    comparison_totals<Device> totals_;
};

}  // namespace gs::train
