// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <string>
#include <utility>

#include "../../core/error.hpp"
#include "memory.hpp"

namespace gs::device {

/// An array in page-locked host memory, from which the GPU copies without help of the host: see
/// `buffer_of`. Growing it loses the contents.
template <class T>
class page_locked_buffer {
  public:
    page_locked_buffer() = default;
    page_locked_buffer(page_locked_buffer&& other) noexcept { swap(other); }
    page_locked_buffer& operator=(page_locked_buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~page_locked_buffer() { cudaFreeHost(memory_); }

    void resize(std::size_t n) {
        if (n > capacity_) {
            cudaFreeHost(std::exchange(memory_, nullptr));
            size_ = capacity_ = 0;
            if (cudaMallocHost(&memory_, n * sizeof(T)) != cudaSuccess) {
                cudaGetLastError();
                throw error("the system refuses " + std::to_string(n * sizeof(T)) +
                            " bytes of page-locked memory for photos: lower --photo-memory");
            }
            capacity_ = n;
        }
        size_ = n;
    }
    T* data() const { return memory_; }
    std::size_t size() const { return size_; }

  private:
    void swap(page_locked_buffer& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    T* memory_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0;
};

/// A place in the order of a stream, such as the end of a copy.
struct cuda_transfer {
    cudaEvent_t event{};

    cuda_transfer() { check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming)); }
    cuda_transfer(const cuda_transfer&) = delete;
    cuda_transfer& operator=(const cuda_transfer&) = delete;
    ~cuda_transfer() { cudaEventDestroy(event); }

    bool is_done() const {
        const cudaError_t status = cudaEventQuery(event);
        if (status == cudaErrorNotReady) {
            cudaGetLastError();  // otherwise the next call of another library reports it
            return false;
        }
        check(status);
        return true;
    }
    void wait() const { check(cudaEventSynchronize(event)); }
};

}  // namespace gs::device
