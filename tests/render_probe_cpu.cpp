// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/simt/serial.hpp>

#include "device/cpu.hpp"
#include "render_probe_on.hpp"

namespace probe {

answer ask_reference(const question& q) {
    return ask<gs::device::basic_cpu<warpagg::emulator::serial>, double>(q);
}
answer ask_lanes(const question& q) { return ask<gs::device::cpu, float>(q); }

}  // namespace probe
