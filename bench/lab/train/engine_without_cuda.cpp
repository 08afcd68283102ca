// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "core/error.hpp"
#include "engines.hpp"

namespace gs::lab {

std::unique_ptr<gs::train::engine> make_cuda_engine() { throw error("this program was built without CUDA"); }

}  // namespace gs::lab
