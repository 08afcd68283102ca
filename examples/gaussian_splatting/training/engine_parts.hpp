// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "../densify/strategies.hpp"
#include "../device/device.hpp"
#include "../losses/losses.hpp"

namespace gs::train {

/// What an engine creates by name, from the tables of the doors unless a caller says otherwise.
template <device::device Device>
struct engine_parts {
    std::unique_ptr<loss<float>> (*make_loss)(Device&, const std::string& name) =
        [](Device& device, const std::string& name) { return losses<Device>::make(device, name); };
    std::unique_ptr<strategy<Device>> (*make_strategy)(Device&, const strategy_settings&,
                                                       const training_facts&) = strategies<Device>::make;
};

}  // namespace gs::train
