// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "adder_on.hpp"
#include "device/cuda/cuda.hpp"

std::unique_ptr<adder> make_cuda_adder() { return std::make_unique<adder_on<gs::device::cuda>>(); }
