// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What the kernels of bench_kernels have in common. Each kernel is a stand-in for a kernel of another
/// project: it has the same loads, arithmetic, control flow and destinations.

#include <cuda_runtime.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../cuda_figures.hpp"

/// An array in GPU memory.
template <class T>
class device_array {
  public:
    explicit device_array(std::size_t size) : size_(size) {
        check(cudaMalloc(&data_, size * sizeof(T)));
        check(cudaMemset(data_, 0, size * sizeof(T)));
    }
    explicit device_array(const std::vector<T>& from) : device_array(from.size()) {
        check(cudaMemcpy(data_, from.data(), size_ * sizeof(T), cudaMemcpyHostToDevice));
    }
    device_array(const device_array&) = delete;
    device_array& operator=(const device_array&) = delete;
    ~device_array() { cudaFree(data_); }

    T* data() const { return data_; }
    std::size_t size() const { return size_; }
    std::vector<T> to_host() const {
        std::vector<T> all(size_);
        check(cudaMemcpy(all.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost));
        return all;
    }

  private:
    T* data_ = nullptr;
    std::size_t size_;
};

/// One way to add the results of a kernel.
struct variant {
    std::string name;
    std::function<void()> launch;
};

/// A kernel with its input. All variants add the same sums to the destination.
struct kernel_case {
    std::string kernel, input;
    std::vector<variant> variants;
    std::function<void()> clear;                 ///< sets the destination to zero
    std::function<std::vector<float>()> result;  ///< the destination
    double tolerance = 1e-3;                     ///< of the sums, as a share of the largest sum
    double idle_share = 0;                       ///< share of warp steps without an active lane
};

/// Creates a case when it is its turn, so that the inputs of other cases take no memory.
using kernel_maker = std::function<kernel_case()>;

std::vector<kernel_maker> blending_cases();
std::vector<kernel_maker> hash_grid_cases();
std::vector<kernel_maker> interpolation_cases();
std::vector<kernel_maker> scatter_cases();
std::vector<kernel_maker> deterministic_scatter_cases();
