// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "loss_names.hpp"

#include "../device/cpu/cpu.hpp"
#include "losses.hpp"

namespace gs::train {

// The names are the same on all devices.
std::vector<std::string> loss_names() { return losses<device::cpu>::names(); }

}  // namespace gs::train
