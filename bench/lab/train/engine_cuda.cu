// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "device/cuda/cuda.hpp"
#include "engines.hpp"
#include "lab/accumulator_set.hpp"
#include "training/device_engine.hpp"

namespace gs::lab {

std::unique_ptr<gs::train::engine> make_cuda_engine() {
    return std::make_unique<gs::train::device_engine<device::cuda, lab_accumulators>>();
}

}  // namespace gs::lab
