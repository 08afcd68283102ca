// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../device/device.hpp"
#include "../model/parameter_memory.hpp"

namespace gs::train {

/// The parameters of the Gaussians in training, with the state of Adam.
template <device::device Device>
struct trained_parameters {
    parameter_memory<Device> values, first, second;  ///< `first` and `second`: Adam's moments
    /// The last step that updated each Gaussian.
    typename Device::template buffer<std::uint32_t> last_step;
};

}  // namespace gs::train
