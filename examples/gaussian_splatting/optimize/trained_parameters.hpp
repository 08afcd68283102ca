// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../device/device.hpp"
#include "../model/parameter_memory.hpp"
#include "adam.hpp"

namespace gs::train {

/// The parameters of the Gaussians in training, with the state of Adam.
template <device::device Device>
struct trained_parameters {
    parameter_memory<Device> values, first, second;  ///< `first` and `second`: Adam's moments
    /// The last step that updated each Gaussian.
    typename Device::template buffer<std::uint32_t> last_step;

    /// Returns the size of the parameters of a Gaussian with their moments.
    static std::size_t bytes_per_gaussian(int sh_degree) {
        return 3 * parameter_memory<Device>::bytes_per_gaussian(sh_degree) + sizeof(std::uint32_t);
    }
    /// Returns whether all arrays have the sizes for this number of Gaussians and this SH degree.
    bool fits(std::size_t count, int sh_degree) const {
        const std::size_t with_sh = values.gaussians_with_sh();
        return values.fits(count, sh_degree) && first.fits(count, sh_degree) &&
               second.fits(count, sh_degree) && last_step.size() == count &&
               first.gaussians_with_sh() == with_sh && second.gaussians_with_sh() == with_sh;
    }
    /// Returns Adam's step number t, counted from 1, with learning rates by `parameter`.
    adam<float> descent(std::uint32_t t, const std::array<float, parameter_count>& rates,
                        const raster::list_capacity& capacity, const finite_check& check) {
        const double by_first = 1 / (1 - std::pow(adam<float>::beta1, t));
        const double by_second = 1 / std::sqrt(1 - std::pow(adam<float>::beta2, t));
        adam<float> step{values.write(),
                         first.write(),
                         second.write(),
                         last_step.data(),
                         t,
                         {},
                         static_cast<float>(by_second),
                         capacity,
                         check};
        for (std::size_t p = 0; p < parameter_count; ++p)
            step.rates[p] = static_cast<float>(rates[p] * by_first);
        return step;
    }
    /// Appends all arrays, for `device::gather`.
    void share(std::vector<ranks::shared_array>& arrays) const {
        for (const auto* memory : {&values, &first, &second}) memory->share(arrays);
        arrays.push_back(ranks::shared_array::of(last_step.data(), block_length, last_step.size()));
    }
    /// Saves or loads all parameters. Waits for the device.
    void exchange(state_archive& archive, Device& device) {
        const auto exchange_memory = [&](const char* name, parameter_memory<Device>& memory) {
            const state_archive::scope scope(archive, name);
            memory.exchange(archive, device);
        };
        exchange_memory("values", values);
        exchange_memory("first_moments", first);
        exchange_memory("second_moments", second);
        exchange_buffer(archive, device, "last_step", last_step);
    }
};

}  // namespace gs::train
