// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "../device/device.hpp"
#include "ordered_sums.hpp"

namespace gs::train {

/// Rows of `Width` numbers on the device, each of which learns by Adam from sums over pictures, by the steps
/// that were its own.
template <device::device Device, unsigned Width>
class learned_numbers {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit learned_numbers(Device& device) : device_(device) {}

    /// What they begin from, row by row, as if there had been no step.
    void set(const std::vector<float>& values) {
        for (auto* memory : {&values_, &first_, &second_}) memory->resize(values.size());
        device_.upload(values_.data(), values.data(), values.size());
        device_.zero(first_.data(), values.size());
        device_.zero(second_.data(), values.size());
        device_.wait();
        steps_.assign(values.size() / Width, 0);
    }
    std::vector<float> get() const {
        std::vector<float> values(Width * rows());
        device_.download(values.data(), values_.data(), values.size());
        return values;
    }

    std::size_t rows() const { return steps_.size(); }
    float* row(std::size_t i) { return values_.data() + i * Width; }

    /// Zeros, for that many warps to add to; what `learn` is then given.
    picture_sums sums(std::size_t warps) {
        if (Width * warps > sums_.size()) {
            sums_.resize(Width * warps);
            device_.zero(sums_.data(), sums_.size());
        }
        return {sums_.data(), warps};
    }
    void learn(std::size_t i, const picture_sums& sums, float rate, const raster::list_room& room) {
        const int t = ++steps_[i];
        const double by_first = 1 - std::pow(static_cast<double>(learn_from_sums::beta1), t);
        const double by_second = 1 - std::pow(static_cast<double>(learn_from_sums::beta2), t);
        device_.for_each_warp(
            Width, learn_from_sums{sums, row(i), first_.data() + i * Width, second_.data() + i * Width,
                                   static_cast<float>(rate / by_first),
                                   static_cast<float>(1 / std::sqrt(by_second)), room});
    }

  private:
    Device& device_;
    buffer<float> values_, first_, second_;
    buffer<float> sums_;      ///< zeros between steps
    std::vector<int> steps_;  ///< of each row
};

}  // namespace gs::train
