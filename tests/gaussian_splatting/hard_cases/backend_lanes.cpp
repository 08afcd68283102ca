// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cpu/cpu.hpp"
#include "on_device.hpp"

namespace hard_cases {

backend lanes_backend() { return make_backend<gs::device::cpu, float>("lanes"); }

}  // namespace hard_cases
