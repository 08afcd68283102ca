// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../device/device.hpp"
#include "../../optimize/adam_parameters.hpp"
#include "response_kernels.hpp"

namespace gs::features {

/// A list of responses on the device. Adam trains each one in the steps that use it.
template <device::device Device>
class responses {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using patch = pixel_patch<typename Device::warp>;

  public:
    explicit responses(Device& device) : device_(device), numbers_(device) {}

    /// Replaces all responses, `response_width` values each, and sets Adam's moments to zero.
    void set(const std::vector<float>& values) { numbers_.set(values); }
    std::vector<float> get() const { return numbers_.get(); }

    void exchange(state_archive& archive) { numbers_.exchange(archive); }

    std::size_t count() const { return numbers_.rows(); }

    /// Returns the render with response i: three planes on the device, valid until the next call.
    const float* show(std::size_t i, const float* render, std::size_t pixels) {
        shown_.resize(3 * pixels);
        device_.for_each_index(pixels, apply_response{render, numbers_.row(i), pixels, shown_.data()});
        return shown_.data();
    }

    /// Returns the gradient with respect to the render, from the gradient with respect to the result of
    /// `show`. Also trains response i. Both images must exist in the rows of `part`; other ranks have the
    /// other rows.
    const float* learn(std::size_t i, const float* render, const float* by_shown, const image_part& part,
                       float rate, const raster::list_capacity& capacity) {
        by_render_.resize(3 * part.pixels());
        const train::ordered_sums sums = numbers_.sums(patch::count(part.width, part.height));
        device_.for_each_warp(patch::count_in(part),
                              respond_backward{render, numbers_.row(i), by_shown, part.width, part.height,
                                               by_render_.data(), sums, patch::first_in(part)});
        numbers_.learn(i, sums, rate, capacity);
        device_.for_each_index(3, keep_rising{numbers_.row(i)});
        return by_render_.data();
    }

  private:
    Device& device_;
    train::adam_parameters<Device, response_width> numbers_;
    buffer<float> shown_, by_render_;
};

}  // namespace gs::features
