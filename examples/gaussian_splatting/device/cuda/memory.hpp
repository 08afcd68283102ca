// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "../../core/error.hpp"
#include "../memory_place.hpp"

namespace gs::device {

inline void check(cudaError_t status) {
    if (status == cudaErrorMemoryAllocation)
        throw error(
            "the GPU is out of memory: lower --gpu-memory, --max-cap, --resolution or --photo-memory");
    if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(status));
}

/// The pool of device memory. It keeps released memory, so that allocations rarely call the driver.
class cuda_pool {
  public:
    cuda_pool() {
        check(cudaDeviceGetDefaultMemPool(&pool_, 0));
        std::uint64_t all = UINT64_MAX;
        check(cudaMemPoolSetAttribute(pool_, cudaMemPoolAttrReleaseThreshold, &all));
    }
    /// Returns the largest number of bytes in use so far.
    std::size_t peak_bytes() const {
        std::uint64_t bytes = 0;
        check(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrUsedMemHigh, &bytes));
        return bytes;
    }
    /// Returns the number of bytes in use.
    std::size_t used_bytes() const {
        std::uint64_t bytes = 0;
        check(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrUsedMemCurrent, &bytes));
        return bytes;
    }
    /// Returns the number of bytes that the pool has released and the GPU has free.
    std::size_t free_bytes() const {
        std::uint64_t reserved = 0;
        check(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrReservedMemCurrent, &reserved));
        std::size_t unreserved = 0, all = 0;
        check(cudaMemGetInfo(&unreserved, &all));
        return unreserved + reserved - used_bytes();
    }

  private:
    cudaMemPool_t pool_{};
};

/// An array in device memory, or in page-locked host memory that kernels reach: see `buffer_of` and
/// `placed_buffer`. Growing it loses the contents.
template <class T>
class cuda_buffer {
  public:
    cuda_buffer() = default;
    cuda_buffer(cuda_buffer&& other) noexcept { swap(other); }
    cuda_buffer& operator=(cuda_buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~cuda_buffer() { release(); }

    void resize(std::size_t n) {
        if (n > capacity_) {
            release();
            allocate(n * sizeof(T));
            capacity_ = n;
        }
        size_ = n;
    }
    void free_in(memory_place place) {
        release();
        place_ = place;
    }
    T* data() const { return memory_; }
    std::size_t size() const { return size_; }

  private:
    /// Returns a stream whose work is ordered after earlier work and before later work of other
    /// streams.
    static cudaStream_t in_order() { return cudaStreamLegacy; }

    void allocate(std::size_t bytes) {
        if (place_ == memory_place::device) return check(cudaMallocAsync(&memory_, bytes, in_order()));
        if (cudaHostAlloc(&memory_, bytes, cudaHostAllocDefault) == cudaSuccess) return;
        cudaGetLastError();  // otherwise the next call of another library reports it
        throw error("the system refuses " + std::to_string(bytes) +
                    " bytes of page-locked memory for SH coefficients: lower --max-cap, or raise "
                    "--gpu-memory");
    }
    void release() {
        if (memory_ == nullptr) return;
        if (place_ == memory_place::device) {
            cudaFreeAsync(memory_, in_order());
        } else {
            cudaStreamSynchronize(in_order());  // kernels may still use the memory
            cudaFreeHost(memory_);
        }
        memory_ = nullptr;
        size_ = capacity_ = 0;
    }
    void swap(cuda_buffer& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
        std::swap(place_, other.place_);
    }

    T* memory_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0;
    memory_place place_ = memory_place::device;
};

}  // namespace gs::device
