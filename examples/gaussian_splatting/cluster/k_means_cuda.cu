// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../device/cuda/cuda.hpp"
#include "device_k_means.hpp"

namespace gs::cluster {

clustering k_means_on_cuda(const std::vector<float>& points, std::size_t width,
                           const std::vector<float>& weights, std::size_t most) {
    return device_k_means<device::cuda>().run(points, width, weights, most);
}

}  // namespace gs::cluster
