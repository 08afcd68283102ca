// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <stdexcept>

#include "ranking.hpp"

namespace gs::lab {

ranking rank_on_cuda(const ranking_setup&) { throw std::logic_error("built without CUDA"); }

}  // namespace gs::lab
