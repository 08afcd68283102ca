// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../device/cpu.hpp"
#include "device_engine.hpp"

namespace gs::train {

std::unique_ptr<engine> make_cpu_engine() { return std::make_unique<device_engine<device::cpu>>(); }

}  // namespace gs::train
