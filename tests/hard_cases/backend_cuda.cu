// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cuda.hpp"
#include "on_device.hpp"

namespace hard_cases {

backend cuda_backend() { return backend_on<gs::device::cuda, float>::make("cuda"); }

}  // namespace hard_cases
