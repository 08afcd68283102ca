// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "adder_on.hpp"
#include "device/cpu/cpu.hpp"

std::unique_ptr<adder> make_cpu_adder() { return std::make_unique<adder_on<gs::device::cpu>>(); }
