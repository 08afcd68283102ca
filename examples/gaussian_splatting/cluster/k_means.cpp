// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "k_means.hpp"

#include "../core/error.hpp"

extern "C" {
// Each function is compiled from k_means_cpu.cpp, for another instruction set.
#if defined(WARPAGG_CPU_LEVELS)
void k_means_x86_64_v3(const std::vector<float>&, std::size_t, const std::vector<float>&, std::size_t,
                       gs::cluster::clustering&);
void k_means_x86_64_v4(const std::vector<float>&, std::size_t, const std::vector<float>&, std::size_t,
                       gs::cluster::clustering&);
#else
void k_means_as_built(const std::vector<float>&, std::size_t, const std::vector<float>&, std::size_t,
                      gs::cluster::clustering&);
#endif
}

namespace gs::cluster {

clustering k_means_on_cpu(const std::vector<float>& points, std::size_t width,
                          const std::vector<float>& weights, std::size_t most) {
    clustering result;
#if defined(WARPAGG_CPU_LEVELS)
    if (__builtin_cpu_supports("x86-64-v4"))
        k_means_x86_64_v4(points, width, weights, most, result);
    else if (__builtin_cpu_supports("x86-64-v3"))
        k_means_x86_64_v3(points, width, weights, most, result);
    else
        throw error(
            "clustering is compiled for AVX2, which this CPU does not have: build with "
            "-DWARPAGG_CPU_LEVELS=OFF -DWARPAGG_CPU_ARCH=native");
#else
    k_means_as_built(points, width, weights, most, result);
#endif
    return result;
}

}  // namespace gs::cluster
