// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "../core/error.hpp"
#include "../device/device.hpp"
#include "l1_ssim/l1_ssim.hpp"
#include "loss.hpp"

namespace gs::train {

/// Creates a loss on a device, which must outlive it.
template <device::device Device>
using loss_factory = std::unique_ptr<loss<float>> (*)(Device& device);

template <device::device Device>
struct loss_entry {
    std::string_view name;
    loss_factory<Device> make;
};

template <class Loss, device::device Device>
std::unique_ptr<loss<float>> make_loss(Device& device) {
    return std::make_unique<Loss>(device);
}

/// All losses. A new one is a line here.
template <device::device Device>
inline constexpr std::array losses{
    loss_entry<Device>{"l1_ssim", make_loss<l1_ssim<Device, float>>},
};

/// Throws `error`, which lists the names, if no loss has this name.
template <device::device Device>
loss_factory<Device> find_loss(std::string_view name) {
    std::string names;
    for (const loss_entry<Device>& entry : losses<Device>) {
        if (entry.name == name) return entry.make;
        names += (names.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw error("no loss is called \"" + std::string(name) + "\"; choose one of: " + names);
}

}  // namespace gs::train
