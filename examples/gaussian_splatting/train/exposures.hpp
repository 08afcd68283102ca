// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "engine.hpp"
#include "exposure_kernels.hpp"

namespace gs::train {

/// The exposures of photos, on the device. They can learn: by Adam, each by the steps that show its photo.
template <class Device>
class exposures {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using warp = typename Device::warp;

  public:
    explicit exposures(Device& device) : device_(device) {}

    /// What the photos begin from, as if no step had shown any.
    void set(const std::vector<exposure>& all) {
        std::vector<float> values;
        for (const exposure& e : all) values.insert(values.end(), e.begin(), e.end());
        for (auto* memory : {&values_, &first_, &second_}) memory->resize(values.size());
        device_.upload(values_.data(), values.data(), values.size());
        device_.zero(first_.data(), values.size());
        device_.zero(second_.data(), values.size());
        device_.wait();
        steps_.assign(all.size(), 0);
    }

    std::size_t count() const { return steps_.size(); }

    /// The picture of a view, on the device, as its photo would have it.
    const float* show(std::size_t view, const float* picture, std::size_t pixels) {
        exposed_.resize(3 * pixels);
        device_.for_each_index(
            pixels, expose{picture, values_.data() + view * exposure_width, pixels, exposed_.data()});
        return exposed_.data();
    }

    /// From the gradient by what `show` returned to that by its picture; learns from it.
    const float* learn(std::size_t view, const float* picture, const float* by_exposed, std::size_t pixels,
                       float rate, const raster::list_room& room) {
        by_picture_.resize(3 * pixels);
        float* const own = values_.data() + view * exposure_width;
        const exposure_sums sums = sums_over(pixels);
        device_.for_each_warp(sums.warps,
                              expose_backward{picture, own, by_exposed, pixels, by_picture_.data(), sums});
        const int t = ++steps_[view];
        const double by_first = 1 - std::pow(static_cast<double>(learn_exposure::beta1), t);
        const double by_second = 1 - std::pow(static_cast<double>(learn_exposure::beta2), t);
        device_.for_each_warp(
            exposure_width,
            learn_exposure{sums, own, first_.data() + view * exposure_width,
                           second_.data() + view * exposure_width, static_cast<float>(rate / by_first),
                           static_cast<float>(1 / std::sqrt(by_second)), room});
        return by_picture_.data();
    }

    /// See `centre_exposures`.
    void centre() { device_.for_each_index(exposure_width, centre_exposures{values_.data(), steps_.size()}); }

    std::vector<exposure> get() const {
        std::vector<exposure> all(steps_.size());
        std::vector<float> values(values_.size());
        device_.download(values.data(), values_.data(), values.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            all[i / exposure_width][i % exposure_width] = values[i];
        return all;
    }

  private:
    exposure_sums sums_over(std::size_t pixels) {
        const std::size_t warps = expose_backward::warps<warp>(pixels), before = sums_.size();
        if (exposure_width * warps > before) {
            sums_.resize(exposure_width * warps);
            device_.zero(sums_.data(), sums_.size());
        }
        return {sums_.data(), warps};
    }

    Device& device_;
    buffer<float> values_, first_, second_, exposed_, by_picture_;
    buffer<float> sums_;      ///< zeros between steps
    std::vector<int> steps_;  ///< that showed each photo
};

}  // namespace gs::train
