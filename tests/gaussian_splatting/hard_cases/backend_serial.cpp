// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <warpagg/warp/serial.hpp>

#include "device/cpu/cpu.hpp"
#include "on_device.hpp"

namespace hard_cases {

backend serial_backend() {
    return make_backend<gs::device::basic_cpu<warpagg::emulator::serial>, float>("serial");
}

}  // namespace hard_cases
