// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../device/device.hpp"
#include "../../optimize/adam_parameters.hpp"
#include "vignetting_kernels.hpp"

namespace gs::features {

/// A list of falloffs on the device. Adam trains each one in the steps that use it.
template <device::device Device>
class falloffs {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using patch = pixel_patch<typename Device::warp>;

  public:
    explicit falloffs(Device& device) : device_(device), numbers_(device) {}

    /// Replaces all falloffs, `falloff_width` values each, and sets Adam's moments to zero.
    void set(const std::vector<float>& values) { numbers_.set(values); }
    std::vector<float> get() const { return numbers_.get(); }

    void exchange(state_archive& archive) { numbers_.exchange(archive); }

    std::size_t count() const { return numbers_.rows(); }

    /// Returns the image with falloff i: three planes on the device, valid until the next call.
    const float* show(std::size_t i, const float* image, const falloff_geometry& geometry) {
        darkened_.resize(3 * static_cast<std::size_t>(geometry.width) *
                         static_cast<std::size_t>(geometry.height));
        device_.for_each_warp(patch::count(geometry.width, geometry.height),
                              darken_corners{image, numbers_.row(i), geometry, darkened_.data()});
        return darkened_.data();
    }

    /// Returns the gradient with respect to the image, from the gradient with respect to the result of
    /// `show`. Also trains falloff i. Both images must exist in the given rows; other ranks have the other
    /// rows.
    const float* learn(std::size_t i, const float* image, const float* by_darkened,
                       const falloff_geometry& geometry, const row_range& rows, float rate,
                       const raster::list_capacity& capacity) {
        const image_part part{geometry.width, geometry.height, rows};
        by_image_.resize(3 * part.pixels());
        const train::ordered_sums sums = numbers_.sums(patch::count(part.width, part.height));
        device_.for_each_warp(patch::count_in(part),
                              darken_corners_backward{image, numbers_.row(i), by_darkened, geometry,
                                                      by_image_.data(), sums, patch::first_in(part)});
        numbers_.learn(i, sums, rate, capacity);
        device_.for_each_index(falloff_width, keep_falling{numbers_.row(i)});
        return by_image_.data();
    }

  private:
    Device& device_;
    train::adam_parameters<Device, falloff_width> numbers_;
    buffer<float> darkened_, by_image_;
};

}  // namespace gs::features
