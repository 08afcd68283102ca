// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cuda/cuda.hpp"
#include "on_device.hpp"

namespace hard_cases {

backend cuda_backend() { return make_backend<gs::device::cuda, float>("cuda"); }

}  // namespace hard_cases
