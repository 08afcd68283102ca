// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cpu/cpu.hpp"
#include "on_device.hpp"

namespace hard_cases {

// Warps as wide as a GPU's, whose patches are cut alike.
backend lanes_32_backend() {
    return make_backend<gs::device::basic_cpu<warpagg::emulator::lanes>, float>("lanes_32");
}

}  // namespace hard_cases
