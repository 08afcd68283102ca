// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include "../device/device.hpp"
#include "state_archive.hpp"

namespace gs {

/// Saves or loads an array in device memory: see `state_archive::exchange`. Loading resizes the
/// buffer. Waits for the device.
template <device::device Device, class Buffer>
void exchange_buffer(state_archive& archive, Device& device, std::string_view name, Buffer& buffer) {
    using element = std::remove_pointer_t<decltype(buffer.data())>;
    std::vector<element> elements(archive.loads() ? 0 : buffer.size());
    if (!elements.empty()) device.download(elements.data(), buffer.data(), elements.size());
    archive.exchange(name, elements);
    if (!archive.loads()) return;
    buffer.resize(elements.size());
    if (!elements.empty()) device.upload(buffer.data(), elements.data(), elements.size());
    device.wait();
}

}  // namespace gs
