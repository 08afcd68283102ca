// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "../checkpoint/exchange_buffer.hpp"
#include "../core/error.hpp"
#include "../device/device.hpp"
#include "ordered_sums.hpp"

namespace gs::train {

/// Rows of `Width` parameters on the device, for example one row per image. Adam (Kingma and Ba
/// 2015) optimizes each row from gradients that are sums over an image, and counts the steps of
/// each row.
template <device::device Device, unsigned Width>
class adam_parameters {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    /// `beta2`: decay of the second moments. Smaller values suit rows that few steps train, whose
    /// first gradients are much larger than later ones.
    explicit adam_parameters(Device& device, float beta2 = 0.999f) : device_(device), beta2_(beta2) {}

    /// Sets all rows, one after another, and resets the state of Adam. Waits for the device.
    void set(const std::vector<float>& values) {
        for (auto* memory : {&values_, &first_, &second_}) memory->resize(values.size());
        device_.upload(values_.data(), values.data(), values.size());
        device_.zero(first_.data(), values.size());
        device_.zero(second_.data(), values.size());
        device_.wait();
        steps_.assign(values.size() / Width, 0);
    }
    /// Changes all values, and keeps the state of Adam. Waits for the device.
    void change(const std::vector<float>& values) {
        device_.upload(values_.data(), values.data(), values.size());
        device_.wait();
    }
    /// Returns all rows, one after another. Waits for the device.
    std::vector<float> get() const {
        std::vector<float> values(Width * rows());
        device_.download(values.data(), values_.data(), values.size());
        return values;
    }

    /// Saves or loads all rows with the state of Adam. Keeps the present rows if the archive has none
    /// or another number of them.
    void exchange(state_archive& archive) {
        std::vector<int> steps = steps_;
        if (archive.loads() && !archive.has("steps")) return;
        archive.exchange("steps", steps);
        if (steps.size() != steps_.size()) return;
        steps_ = steps;
        exchange_buffer(archive, device_, "values", values_);
        exchange_buffer(archive, device_, "first_moments", first_);
        exchange_buffer(archive, device_, "second_moments", second_);
        for (const auto* memory : {&values_, &first_, &second_})
            if (memory->size() != Width * rows())
                throw error("the checkpoint has learned values that do not fit their number of steps");
    }

    std::size_t rows() const { return steps_.size(); }
    /// Returns a pointer to row i, in device memory.
    float* row(std::size_t i) { return values_.data() + i * Width; }

    /// Returns sums of zero. `warps` warps add the gradient of a row to them before `learn`.
    ordered_sums sums(std::size_t warps) {
        if (Width * warps > sums_.size()) {
            sums_.resize(Width * warps);
            device_.zero(sums_.data(), sums_.size());
        }
        return {sums_.data(), warps};
    }
    /// Makes a step of row i, unless the tile lists of the view did not fit. Sets the sums to zero. With
    /// several ranks, each one has added the sums of other warps.
    void learn(std::size_t i, const ordered_sums& sums, float rate, const raster::list_capacity& capacity) {
        device_.sum_over_ranks(sums.parts, Width * sums.warps);
        learn_alone(i, sums, rate, capacity);
    }
    /// Like `learn`, for sums that this rank has added without the others.
    void learn_alone(std::size_t i, const ordered_sums& sums, float rate,
                     const raster::list_capacity& capacity) {
        const int t = ++steps_[i];
        const double by_first = 1 - std::pow(static_cast<double>(adam_from_sums::beta1), t);
        const double by_second = 1 - std::pow(static_cast<double>(beta2_), t);
        device_.for_each_warp(
            Width, adam_from_sums{sums, row(i), first_.data() + i * Width, second_.data() + i * Width,
                                  static_cast<float>(rate / by_first),
                                  static_cast<float>(1 / std::sqrt(by_second)), beta2_, capacity});
    }

  private:
    Device& device_;
    float beta2_;
    buffer<float> values_, first_, second_;
    buffer<float> sums_;      ///< zero between steps
    std::vector<int> steps_;  ///< number of steps of each row
};

}  // namespace gs::train
