// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../device/device.hpp"
#include "../../optimize/adam_parameters.hpp"
#include "exposure_kernels.hpp"

namespace gs::features {

/// The exposures of a list of views on the device. Adam trains each exposure in the steps that use
/// its view.
template <device::device Device>
class exposures {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using warp = typename Device::warp;

  public:
    explicit exposures(Device& device) : device_(device), numbers_(device) {}

    /// Replaces all exposures, `exposure_width` values per view, and sets Adam's moments to zero.
    void set(const std::vector<float>& values) { numbers_.set(values); }
    std::vector<float> get() const { return numbers_.get(); }

    void exchange(state_archive& archive) { numbers_.exchange(archive); }

    std::size_t count() const { return numbers_.rows(); }

    /// Returns the render with the exposure of a view: three planes on the device, valid until the
    /// next call.
    const float* show(std::size_t view, const float* render, std::size_t pixels) {
        exposed_.resize(3 * pixels);
        device_.for_each_index(pixels, expose{render, numbers_.row(view), pixels, exposed_.data()});
        return exposed_.data();
    }

    /// Returns the gradient with respect to the render, from the gradient with respect to the
    /// result of `show`. Also trains the exposure. Both images must exist in the rows of `part`; other
    /// ranks have the other rows.
    const float* learn(std::size_t view, const float* render, const float* by_exposed, const image_part& part,
                       float rate, const raster::list_capacity& capacity) {
        using patch = pixel_patch<warp>;
        by_render_.resize(3 * part.pixels());
        const train::ordered_sums sums = numbers_.sums(patch::count(part.width, part.height));
        device_.for_each_warp(patch::count_in(part),
                              expose_backward{render, numbers_.row(view), by_exposed, part.width, part.height,
                                              by_render_.data(), sums, patch::first_in(part)});
        numbers_.learn(view, sums, rate, capacity);
        return by_render_.data();
    }

    /// Makes the mean of all exposures the identity: see `normalize_exposures`.
    void normalize() {
        device_.for_each_index(exposure_width, normalize_exposures{numbers_.row(0), count()});
    }

  private:
    Device& device_;
    train::adam_parameters<Device, exposure_width> numbers_;
    buffer<float> exposed_, by_render_;
};

}  // namespace gs::features
