// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What the benches of kernels share: time by events, and where figures come from.

#include <cuda_runtime.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "driver.hpp"

inline void check(cudaError_t status) {
    if (status != cudaSuccess) throw std::runtime_error(cudaGetErrorString(status));
}

class stopwatch {
  public:
    stopwatch() {
        check(cudaEventCreate(&from_));
        check(cudaEventCreate(&to_));
    }
    /// Returns the milliseconds that the GPU takes for the launches of `f`.
    template <class F>
    double milliseconds(const F& f) {
        check(cudaEventRecord(from_));
        f();
        check(cudaGetLastError());
        check(cudaEventRecord(to_));
        check(cudaEventSynchronize(to_));
        float ms = 0;
        check(cudaEventElapsedTime(&ms, from_, to_));
        return static_cast<double>(ms);
    }

  private:
    cudaEvent_t from_{}, to_{};
};

/// GPU, driver, compiler and commit.
inline nlohmann::ordered_json figures_of_this_gpu(const char* bench) {
    cudaDeviceProp gpu{};
    check(cudaGetDeviceProperties(&gpu, 0));
    int driver_api = 0;
    check(cudaDriverGetVersion(&driver_api));
    return {{"bench", bench},           {"gpu", gpu.name},      {"driver", driver_version()},
            {"driver_api", driver_api}, {"nvcc", WARPAGG_NVCC}, {"commit", WARPAGG_COMMIT}};
}
