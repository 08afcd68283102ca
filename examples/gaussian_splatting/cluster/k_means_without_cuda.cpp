// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../core/error.hpp"
#include "k_means.hpp"

namespace gs::cluster {

clustering k_means_on_cuda(const std::vector<float>&, std::size_t, const std::vector<float>&, std::size_t) {
    throw error("this program was built without CUDA");
}

}  // namespace gs::cluster
