// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "../device/device.hpp"
#include "../optimize/finite_check.hpp"
#include "../render/geometry/list_capacity.hpp"

namespace gs::train {

/// Ends a step. Counts it if it was skipped, stores the length of its tile lists, and checks that
/// the loss is finite and that no gradient sum was left out. One index.
struct close_step {
    raster::list_capacity capacity;
    std::uint64_t* skipped;
    std::uint64_t* length;  ///< receives the length of the view's tile lists
    const double* sums;     ///< see `loss::sums`
    std::size_t sum_count;
    std::uint32_t* unfit;  ///< see `gradient_sums::fault`
    train::finite_check check;

    WARPAGG_HD void operator()(std::size_t) const {
        if (capacity.exceeded()) ++*skipped;
        *length = *capacity.required;
        double sum = 0;
        for (std::size_t k = 0; k < sum_count; ++k) sum += sums[k];
        if (!raster::is_finite(sum)) check.note(fault_kind::loss, 0, 0);
        if (*unfit != 0) check.note(fault_kind::sum, 0, 0);
        *unfit = 0;
    }
};

/// Counts skipped steps and faults on the device, and reports them on request.
template <device::device Device>
class step_monitor {
  public:
    explicit step_monitor(Device& device) : device_(device) {
        skipped_.resize(1);
        faults_.resize(1);
        reset();
    }

    train::finite_check check_of(int iteration) {
        return {faults_.data(), static_cast<std::uint32_t>(iteration)};
    }
    template <class Renderer>
    void close(const Renderer& renderer, std::span<const double> loss_sums, std::uint64_t* length,
               int iteration) {
        device_.for_each_index(1, close_step{renderer.capacity(), skipped_.data(), length, loss_sums.data(),
                                             loss_sums.size(), renderer.fault(), check_of(iteration)});
    }

    /// Returns the number of skipped steps since the last call of `take_faults`. Waits for the
    /// device.
    std::uint64_t skipped() {
        std::uint64_t n = 0;
        device_.download(&n, skipped_.data(), 1);
        return n;
    }
    /// Returns the faults since the last call, of all ranks. Resets all counters. Waits for the device.
    fault_reports take_faults() {
        finite_check::memory found;
        device_.download(&found, faults_.data(), 1);
        reset();
        device_.ranks().minimum(found.first, fault_kind_count);
        // Each rank checks its own Gaussians. All ranks find the other faults together.
        for (std::size_t k = 0; k < fault_kind_count; ++k) {
            const auto kind = static_cast<fault_kind>(k);
            const bool is_of_gaussian = kind == fault_kind::gradient || kind == fault_kind::parameter;
            std::uint64_t count = found.count[k];
            is_of_gaussian ? device_.ranks().sum(&count, 1) : device_.ranks().maximum(&count, 1);
            found.count[k] = count;
        }
        return finite_check::decode(found);
    }

  private:
    void reset() {
        device_.zero(skipped_.data(), 1);
        const finite_check::memory clean = finite_check::clean();
        device_.upload(faults_.data(), &clean, 1);
        device_.wait();
    }

    Device& device_;
    typename Device::template buffer<std::uint64_t> skipped_;
    typename Device::template buffer<finite_check::memory> faults_;
};

}  // namespace gs::train
