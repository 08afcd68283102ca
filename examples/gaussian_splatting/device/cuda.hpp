// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#include <warpagg/atomic.hpp>

#include "../error.hpp"
#include "scratch.hpp"
#include "stages.hpp"

namespace gs::device {

inline void check(cudaError_t status) {
    if (status == cudaErrorMemoryAllocation)
        throw error("the GPU is out of memory: lower --max-cap or --resolution");
    if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(status));
}

namespace detail {

constexpr unsigned block_size = 128;
constexpr unsigned warps_per_block = block_size / 32;

struct wide_sum {
    __device__ std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

template <class F>
__global__ void for_each_index(std::size_t n, F f) {
    const std::size_t i = std::size_t{blockIdx.x} * block_size + threadIdx.x;
    if (i < n) f(i);
}

template <class F>
__global__ void for_each_element(std::size_t n, F f) {
    const std::size_t i = std::size_t{blockIdx.x} * block_size + threadIdx.x;
    if (i < n && !f.skip() && !f(i)) f.report(i);
}

template <class F>
__global__ void __launch_bounds__(block_size) for_each_warp(unsigned n, F f) {
    const unsigned i = blockIdx.x * warps_per_block + threadIdx.x / 32;
    using warp = warpagg::cuda::warp;
    if constexpr (has_scratch<F, warp>) {
        __shared__ typename F::template scratch<warp> scratch[warps_per_block];
        if (i < n) f(warp{}, i, scratch[threadIdx.x / 32]);
    } else {
        if (i < n) f(warp{}, i);
    }
}

}  // namespace detail

/// A CUDA device and a stream on it. The interface is that of `basic_cpu`.
class cuda {
  public:
    using warp = warpagg::cuda::warp;

    /// Memory of the device. Growing it loses the contents.
    template <class T>
    class buffer {
      public:
        buffer() = default;
        buffer(buffer&& other) noexcept { swap(other); }
        buffer& operator=(buffer&& other) noexcept {
            swap(other);
            return *this;
        }
        ~buffer() { release(); }

        void resize(std::size_t n) {
            if (n > capacity_) {
                release();
                check(cudaMalloc(&memory_, n * sizeof(T)));
                capacity_ = n;
                allocated(static_cast<std::ptrdiff_t>(bytes()));
            }
            size_ = n;
        }
        T* data() const { return memory_; }
        std::size_t size() const { return size_; }
        std::size_t bytes() const { return capacity_ * sizeof(T); }

      private:
        void release() {
            if (memory_ == nullptr) return;
            cudaFree(memory_);
            allocated(-static_cast<std::ptrdiff_t>(bytes()));
            memory_ = nullptr;
            size_ = capacity_ = 0;
        }
        void swap(buffer& other) noexcept {
            std::swap(memory_, other.memory_);
            std::swap(size_, other.size_);
            std::swap(capacity_, other.capacity_);
        }

        T* memory_ = nullptr;
        std::size_t size_ = 0, capacity_ = 0;
    };

    cuda() {
        check(cudaStreamCreate(&stream_));
        int processors = 0;
        check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, 0));
        resident_warps_ = 32 * static_cast<std::size_t>(processors);
        for (auto& e : marks_) check(cudaEventCreate(&e));
    }
    cuda(const cuda&) = delete;
    cuda& operator=(const cuda&) = delete;
    ~cuda() {
        for (auto& e : marks_) cudaEventDestroy(e);
        cudaStreamDestroy(stream_);
    }

    std::string name() const {
        cudaDeviceProp properties{};
        check(cudaGetDeviceProperties(&properties, 0));
        return std::string("cuda, ") + properties.name;
    }

    /// About as many warps as run at once: more of them wait, fewer leave the device idle.
    std::size_t resident_warps() const { return resident_warps_; }

    /// f(i) for each i in [0, n).
    template <class F>
    void for_each_index(std::size_t n, const F& f) {
        if (n == 0) return;
        detail::for_each_index<<<blocks(n, detail::block_size), detail::block_size, 0, stream_>>>(n, f);
        check(cudaGetLastError());
    }
    /// The same for plain arithmetic on arrays; and not at all if f.skip(), which the device finds out. f(i)
    /// says whether all is well with i; if not, f.report(i) is called.
    template <class F>
    void for_each_element(std::size_t n, const F& f) {
        if (n == 0) return;
        detail::for_each_element<<<blocks(n, detail::block_size), detail::block_size, 0, stream_>>>(n, f);
        check(cudaGetLastError());
    }
    /// f(warp, i) for each i in [0, n), each on a warp of its own; f(warp, i, scratch) if it has scratch.
    template <class F>
    void for_each_warp(std::size_t n, const F& f) {
        if (n == 0) return;
        detail::for_each_warp<<<blocks(n, detail::warps_per_block), detail::block_size, 0, stream_>>>(
            static_cast<unsigned>(n), f);
        check(cudaGetLastError());
    }

    template <class T>
    void zero(T* p, std::size_t n) {
        if (n > 0) check(cudaMemsetAsync(p, 0, n * sizeof(T), stream_));
    }
    template <class T>
    void upload(T* to, const T* from, std::size_t n) {
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyHostToDevice, stream_));
    }
    /// Waits for the device, as does whoever reads a result of it.
    template <class T>
    void download(T* to, const T* from, std::size_t n) {
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToHost, stream_));
        wait();
    }

    /// out[i] = in[0] + ... + in[i - 1] for i in [0, n]; out has n + 1 elements.
    void prefix_sum(const buffer<std::uint32_t>& in, buffer<std::uint64_t>& out, std::size_t n) {
        check(cudaMemsetAsync(out.data(), 0, sizeof(std::uint64_t), stream_));
        if (n == 0) return;
        const auto scan = [&](void* scratch, std::size_t& bytes) {
            return cub::DeviceScan::InclusiveScan(scratch, bytes, in.data(), out.data() + 1,
                                                  detail::wide_sum{}, n, stream_);
        };
        with_scratch(scan);
    }

    /// Sorts the first n pairs by the low `bits` of their keys; pairs of equal keys keep their order.
    void sort_pairs(buffer<std::uint32_t>& keys, buffer<std::uint32_t>& values, std::size_t n, int bits) {
        if (n == 0) return;
        other_keys_.resize(keys.size());
        other_values_.resize(values.size());
        cub::DoubleBuffer<std::uint32_t> k(keys.data(), other_keys_.data());
        cub::DoubleBuffer<std::uint32_t> v(values.data(), other_values_.data());
        const auto sort = [&](void* scratch, std::size_t& bytes) {
            return cub::DeviceRadixSort::SortPairs(scratch, bytes, k, v, n, 0, bits, stream_);
        };
        with_scratch(sort);
        if (k.selector == 1) std::swap(keys, other_keys_);
        if (v.selector == 1) std::swap(values, other_values_);
    }

    /// Times every n-th iteration from now on.
    void sample_times(int every) {
        collect();
        sampling_ = every;
        iteration_ = 0;
        times_ = {};
    }
    /// What follows belongs to no iteration.
    void pause_times(bool paused) { paused_ = paused; }
    /// Marks where a stage begins.
    void begin(stage s) {
        if (paused_ || iteration_ % sampling_ != 0) return;
        check(cudaEventRecord(marks_[static_cast<std::size_t>(s)], stream_));
        pending_[static_cast<std::size_t>(s)] = true;
    }
    void end_iteration() {
        begin(stage::count);
        if (++iteration_ % sampling_ == 0) collect();
    }
    const stage_times& times() {
        collect();
        return times_;
    }

    std::size_t peak_bytes() const { return peak(); }
    void wait() { check(cudaStreamSynchronize(stream_)); }

  private:
    static unsigned blocks(std::size_t n, unsigned each) {
        return static_cast<unsigned>((n + each - 1) / each);
    }

    template <class F>
    void with_scratch(const F& f) {
        std::size_t bytes = 0;
        check(f(nullptr, bytes));
        scratch_.resize(bytes + 1);
        check(f(scratch_.data(), bytes));
    }

    /// The times of the last sampled iteration, long done when the next one is.
    void collect() {
        std::size_t from = marks_.size();
        for (std::size_t s = 0; s < marks_.size(); ++s) {
            if (!pending_[s]) continue;
            if (from < marks_.size()) {
                float ms = 0;
                check(cudaEventSynchronize(marks_[s]));
                check(cudaEventElapsedTime(&ms, marks_[from], marks_[s]));
                times_.milliseconds[from] += ms;
            }
            from = s;
            pending_[s] = false;
        }
        if (from < marks_.size()) ++times_.sampled;
    }

    static std::size_t& peak() {
        static std::size_t bytes = 0;
        return bytes;
    }
    static void allocated(std::ptrdiff_t bytes) {
        static std::ptrdiff_t now = 0;
        now += bytes;
        peak() = std::max(peak(), static_cast<std::size_t>(now));
    }

    cudaStream_t stream_{};
    std::size_t resident_warps_ = 0;
    buffer<std::uint32_t> other_keys_, other_values_;
    buffer<char> scratch_;
    std::array<cudaEvent_t, static_cast<std::size_t>(stage::count) + 1> marks_{};
    std::array<bool, static_cast<std::size_t>(stage::count) + 1> pending_{};
    stage_times times_;
    bool paused_ = false;
    int sampling_ = 50, iteration_ = 0;  // the events of every iteration would cost more than they tell
};

}  // namespace gs::device
