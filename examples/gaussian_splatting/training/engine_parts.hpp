// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "../densify/strategies.hpp"
#include "../device/device.hpp"
#include "../losses/losses.hpp"

namespace gs::train {

/// The functions that create the loss and the densification strategy of an engine. By default they
/// select them by name from `losses` and `strategies`; tests can replace them.
template <device::device Device>
struct engine_parts {
    std::unique_ptr<loss<float>> (*make_loss)(Device&, const std::string& name) =
        [](Device& device, const std::string& name) { return losses<Device>::make(device, name); };
    std::unique_ptr<strategy<Device>> (*make_strategy)(Device&, const strategy_settings&,
                                                       const training_facts&) = strategies<Device>::make;
};

}  // namespace gs::train
