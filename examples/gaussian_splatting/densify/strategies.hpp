// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "../core/error.hpp"
#include "adaptive/adaptive.hpp"
#include "strategy.hpp"
#include "strategy_settings.hpp"

namespace gs::train {

/// Creates a strategy for a training on a device.
template <device::device Device>
using strategy_factory = std::unique_ptr<strategy<Device>> (*)(Device&, const strategy_settings&,
                                                               const training_facts&);

/// The factory of `Strategy`, whose settings are the member `Config` of `strategy_settings`.
template <device::device Device, template <device::device> class Strategy, auto Config>
std::unique_ptr<strategy<Device>> create(Device& device, const strategy_settings& settings,
                                         const training_facts& facts) {
    return std::make_unique<Strategy<Device>>(device, settings.*Config, facts);
}

template <device::device Device>
struct strategy_entry {
    std::string_view name;
    strategy_factory<Device> make;
};

/// All strategies: a new one needs a line here and a member in `strategy_settings`.
template <device::device Device>
inline constexpr std::array strategies{
    strategy_entry<Device>{"adaptive", create<Device, adaptive, &strategy_settings::adaptive>},
};

/// Creates the strategy that `settings` name. Throws `error` if there is none of that name.
template <device::device Device>
std::unique_ptr<strategy<Device>> make_strategy(Device& device, const strategy_settings& settings,
                                                const training_facts& facts) {
    std::string known;
    for (const auto& entry : strategies<Device>) {
        if (entry.name == settings.name) return entry.make(device, settings, facts);
        known += known.empty() ? "" : ", ";
        known += entry.name;
    }
    throw error("unknown densification strategy '" + settings.name + "': choose one of " + known);
}

}  // namespace gs::train
