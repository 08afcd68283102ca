// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <tuple>
#include <type_traits>

#include "../core/enumerated.hpp"
#include "../core/error.hpp"
#include "adaptive/adaptive.hpp"
#include "error/error.hpp"
#include "mcmc/mcmc.hpp"
#include "strategy.hpp"
#include "strategy_settings.hpp"

namespace gs::train {

/// The densification strategies on a device, one for each settings type of `strategy_settings`.
template <device::device Device, class... Strategy>
struct strategy_list {
    static_assert(sizeof...(Strategy) == std::tuple_size_v<strategy_settings::configs>,
                  "each strategy has settings in strategy_settings.hpp, and each settings a strategy");

    /// Creates the strategy named in `settings`. The device must outlive it. Throws `error`, which
    /// lists the known names, if the name is unknown.
    static std::unique_ptr<strategy<Device>> make(Device& device, const strategy_settings& settings,
                                                  const training_facts& facts) {
        std::unique_ptr<strategy<Device>> made;
        const auto make_if_named = [&]<class One>(std::type_identity<One>) {
            using config = typename One::settings;
            if (settings.name == config::name)
                made = std::make_unique<One>(device, settings.of<config>(), facts);
        };
        (make_if_named(std::type_identity<Strategy>{}), ...);
        if (made) return made;
        throw error("no densification strategy is called \"" + settings.name + "\": choose " +
                    enumerated(strategy_settings::names(), " or "));
    }
};

/// All strategies. To add one, add it here and add its settings to `strategy_settings::configs`.
template <device::device Device>
using strategies = strategy_list<Device, adaptive<Device>, error_driven<Device>, mcmc<Device>>;

}  // namespace gs::train
