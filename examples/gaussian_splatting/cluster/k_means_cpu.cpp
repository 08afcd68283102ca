// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../device/cpu/cpu.hpp"
#include "device_k_means.hpp"

#if !defined(WARPAGG_K_MEANS)
#define WARPAGG_K_MEANS k_means_as_built
#endif

namespace {

/// Restores the treatment of denormals, which the device changes in all threads.
class restored_denormals {
  public:
    restored_denormals() = default;
    restored_denormals(const restored_denormals&) = delete;
    restored_denormals& operator=(const restored_denormals&) = delete;
#if defined(__SSE__)
    ~restored_denormals() {
#pragma omp parallel
        _mm_setcsr(before_);
    }

  private:
    unsigned before_ = _mm_getcsr();
#endif
};

}  // namespace

/// Clusters with the instruction set that this file is compiled for. See k_means.cpp.
extern "C" void WARPAGG_K_MEANS(const std::vector<float>& points, std::size_t width,
                                const std::vector<float>& weights, std::size_t most,
                                gs::cluster::clustering& result) {
    [[maybe_unused]] const restored_denormals restored;
    result = gs::cluster::device_k_means<gs::device::cpu>().run(points, width, weights, most);
}
