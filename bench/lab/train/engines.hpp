// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "engine/engine.hpp"

namespace gs::lab {

/// The trainer's engine with all accumulators of the lab. The CPU's is compiled for one instruction set only.
/// @{
std::unique_ptr<gs::train::engine> make_cpu_engine();
std::unique_ptr<gs::train::engine> make_cuda_engine();  ///< throws `error` in builds without CUDA
/// @}

}  // namespace gs::lab
