// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../device/device.hpp"
#include "../../optimize/adam_parameters.hpp"
#include "exposure_kernels.hpp"

namespace gs::features {

/// The exposures of photos, on the device. They can learn: by Adam, each by the steps that show its photo.
template <device::device Device>
class exposures {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using warp = typename Device::warp;

  public:
    explicit exposures(Device& device) : device_(device), numbers_(device) {}

    /// What the photos begin from, as if no step had shown any.
    void set(const std::vector<exposure>& all) {
        std::vector<float> values;
        for (const exposure& e : all) values.insert(values.end(), e.begin(), e.end());
        numbers_.set(values);
    }

    std::size_t count() const { return numbers_.rows(); }

    /// The image of a view, on the device, as its photo would have it.
    const float* show(std::size_t view, const float* render, std::size_t pixels) {
        exposed_.resize(3 * pixels);
        device_.for_each_index(pixels, expose{render, numbers_.row(view), pixels, exposed_.data()});
        return exposed_.data();
    }

    /// From the gradient by what `show` returned to that by its image; learns from it.
    const float* learn(std::size_t view, const float* render, const float* by_exposed, std::size_t pixels,
                       float rate, const raster::list_capacity& capacity) {
        by_render_.resize(3 * pixels);
        const train::ordered_sums sums = numbers_.sums(expose_backward::warps<warp>(pixels));
        device_.for_each_warp(sums.warps, expose_backward{render, numbers_.row(view), by_exposed, pixels,
                                                          by_render_.data(), sums});
        numbers_.learn(view, sums, rate, capacity);
        return by_render_.data();
    }

    /// See `normalize_exposures`.
    void normalize() {
        device_.for_each_index(exposure_width, normalize_exposures{numbers_.row(0), count()});
    }

    std::vector<exposure> get() const {
        std::vector<exposure> all(count());
        const std::vector<float> values = numbers_.get();
        for (std::size_t i = 0; i < values.size(); ++i)
            all[i / exposure_width][i % exposure_width] = values[i];
        return all;
    }

  private:
    Device& device_;
    train::adam_parameters<Device, exposure_width> numbers_;
    buffer<float> exposed_, by_render_;
};

}  // namespace gs::features
