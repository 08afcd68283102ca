// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>
#include <warpagg/warp/cuda.hpp>

namespace {

inline void check_cuda(cudaError_t result, const char* call) {
    if (result != cudaSuccess)
        throw std::runtime_error(std::string(call) + ": " + cudaGetErrorString(result));
}

template <class T>
class device_memory {
  public:
    explicit device_memory(const std::vector<T>& content) : size_(content.size()) {
        check_cuda(cudaMalloc(reinterpret_cast<void**>(&first_), bytes()), "cudaMalloc");
        check_cuda(cudaMemcpy(first_, content.data(), bytes(), cudaMemcpyHostToDevice), "upload");
    }
    device_memory(const device_memory&) = delete;
    device_memory& operator=(const device_memory&) = delete;
    ~device_memory() {
        // After a failed kernel every call fails; what failed first has been thrown already.
        if (const cudaError_t result = cudaFree(first_); result != cudaSuccess)
            std::fprintf(stderr, "cudaFree: %s\n", cudaGetErrorString(result));
    }

    T* data() { return first_; }
    std::vector<T> download() const {
        std::vector<T> content(size_);
        check_cuda(cudaMemcpy(content.data(), first_, bytes(), cudaMemcpyDeviceToHost), "download");
        return content;
    }

  private:
    std::size_t bytes() const { return size_ * sizeof(T); }

    T* first_ = nullptr;
    std::size_t size_;
};

/// Something with `data()` on the device, where std::span's is a host function.
template <class T>
struct device_span {
    T* first;
    std::size_t size;
    WARPAGG_HD T* data() const { return first; }
};

template <class F>
__global__ void one_warp(F f) {
    f(warpagg::cuda_warp{});
}

template <class F>
__global__ void one_block(F f) {
    f(warpagg::cuda_warp{}, threadIdx.x / 32);
}

__global__ void nothing() {}

/// The compute capability that the running code was compiled for, times ten.
inline int compute_capability() {
    cudaFuncAttributes of{};
    check_cuda(cudaFuncGetAttributes(&of, nothing), "cudaFuncGetAttributes");
    return of.ptxVersion;
}

/// See lanes.hpp.
struct backend {
    using warp = warpagg::cuda_warp;
    static constexpr const char* name = "cuda";
    static constexpr bool commits_in_lane_order = false;
    static constexpr unsigned every_nth_mask = 1;
    template <class T>
    static bool packs() {
        return std::is_same_v<T, float> && compute_capability() >= 90;
    }

    template <class T>
    using memory = device_memory<T>;
    template <class T>
    using span = device_span<T>;

    template <class T>
    __device__ static T* shared(const warp&, unsigned size) {
        __shared__ T memory[32 * 1024 / sizeof(T)];
        if (size > 32 * 1024 / sizeof(T)) __trap();
        return memory;
    }
    template <class W>
    __device__ static void barrier(const W&) {
        __syncthreads();
    }

    static constexpr unsigned most_warps = 32;
    template <class F>
    static void launch_block(unsigned warps, const F& f) {
        one_block<<<1, warps * 32>>>(f);
        check_cuda(cudaGetLastError(), "launch");
        check_cuda(cudaDeviceSynchronize(), "kernel");
    }
    template <class F>
    static void launch(const F& f) {
        one_warp<<<1, 32>>>(f);
        check_cuda(cudaGetLastError(), "launch");
        check_cuda(cudaDeviceSynchronize(), "kernel");
    }
};

}  // namespace
