// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cuda.hpp"
#include "render_probe_on.hpp"

namespace probe {

answer ask_cuda(const question& q) { return ask<gs::device::cuda, float>(q); }

}  // namespace probe
