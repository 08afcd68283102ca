// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <stdexcept>

#include "measure.hpp"

namespace gs::lab {

paper_figures measure_on_cuda(const paper_subject&) { throw std::logic_error("built without CUDA"); }

}  // namespace gs::lab
