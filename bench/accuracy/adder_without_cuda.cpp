// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <stdexcept>

#include "adder.hpp"

std::unique_ptr<adder> make_cuda_adder() { throw std::logic_error("built without CUDA"); }
