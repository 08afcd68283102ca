// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../device/cuda/cuda.hpp"
#include "device_engine.hpp"

namespace gs::train {

std::unique_ptr<engine> make_cuda_engine() { return std::make_unique<device_engine<device::cuda>>(); }

}  // namespace gs::train
