// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "../device/device.hpp"
#include "image_quality.hpp"

namespace gs::train {

/// The totals of a comparison over all pixels and color channels. `total_values` is the number of
/// values.
enum comparison_total {
    total_absolute_error,
    total_square_error,
    total_ssim,
    total_values,
    comparison_total_count
};

/// Totals on a device, to which kernels add: one sum per `comparison_total`.
template <device::device Device>
class comparison_totals {
  public:
    explicit comparison_totals(Device& device) : device_(device) {
        sums_.resize(comparison_total_count);
        device_.zero(sums_.data(), comparison_total_count);
    }

    double* data() { return sums_.data(); }
    std::span<double> sums() const { return {sums_.data(), sums_.size()}; }

    /// Returns the means since the last call, and sets the totals to zero. Waits for the device.
    image_quality take() {
        double totals[comparison_total_count];
        device_.download(totals, sums_.data(), comparison_total_count);
        device_.zero(sums_.data(), comparison_total_count);
        const double n = totals[total_values];
        return {totals[total_absolute_error] / n, totals[total_square_error] / n, totals[total_ssim] / n};
    }

  private:
    Device& device_;
    typename Device::template buffer<double> sums_;
};

}  // namespace gs::train
