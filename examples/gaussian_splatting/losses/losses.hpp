// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "../core/enumerated.hpp"
#include "../core/error.hpp"
#include "../device/device.hpp"
#include "l1_ssim/l1_ssim.hpp"
#include "loss.hpp"

namespace gs::train {

/// A list of losses on a device, with different names.
template <device::device Device, class... Loss>
struct loss_list {
    static std::vector<std::string> names() { return {std::string(Loss::name)...}; }

    /// Creates the loss with this name. The device must outlive it. Throws `error`, which lists the
    /// known names, if the name is unknown.
    static std::unique_ptr<loss<float>> make(Device& device, std::string_view name) {
        std::unique_ptr<loss<float>> made;
        const auto make_if_named = [&]<class One>(std::type_identity<One>) {
            if (One::name == name) made = std::make_unique<One>(device);
        };
        (make_if_named(std::type_identity<Loss>{}), ...);
        if (made) return made;
        throw error("no loss is called \"" + std::string(name) + "\": choose " + enumerated(names(), " or "));
    }
};

/// All losses. Add a new one here.
template <device::device Device>
using losses = loss_list<Device, l1_ssim<Device, float>>;

}  // namespace gs::train
