// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <vector>
#include <warpagg/atomic.hpp>

namespace example {

inline void check(cudaError_t status) {
    if (status != cudaSuccess) throw std::runtime_error(cudaGetErrorString(status));
}

template <class W, class Kernel>
__global__ void launch(W w, Kernel kernel) {
    const unsigned first = blockIdx.x * blockDim.x + threadIdx.x / W::size * W::size;
    if (first < kernel.lanes()) kernel(w, first);  // a whole warp runs or does not
}

/// Counts atomic operations, those of each lane, as the emulator does.
struct counting_warp : warpagg::cuda_warp {
    unsigned long long* atomics;

    template <class Op, class Dst, class Index, class T>
    __device__ void atomic(Op op, Dst dst, Index index, T v, bool active) const {
        if (active) atomicAdd(atomics, 1ull);
        warpagg::cuda_warp::atomic(op, dst, index, v, active);
    }
    template <unsigned K>
    void atomic_add_packed() const = delete;  // so that each float is committed, and counted, by itself
};

/// The GPU.
struct machine {
    static constexpr const char* name = "the GPU";
    static constexpr unsigned default_size = 1u << 22;
    static constexpr const char* cost_columns = "ms | faster";
    static constexpr const char* rule = "| --- | --- | --- | --- | --- | --- |";

    template <class T>
    class array {
      public:
        explicit array(std::size_t size) : size_(size) {
            check(cudaMalloc(&first_, bytes()));
            zero();
        }
        explicit array(const std::vector<T>& content) : array(content.size()) {
            check(cudaMemcpy(first_, content.data(), bytes(), cudaMemcpyHostToDevice));
        }
        array(const array&) = delete;
        array& operator=(const array&) = delete;
        ~array() { cudaFree(first_); }

        T* data() { return first_; }
        void zero() { check(cudaMemset(first_, 0, bytes())); }
        std::vector<T> download() const {
            std::vector<T> content(size_);
            check(cudaMemcpy(content.data(), first_, bytes(), cudaMemcpyDeviceToHost));
            return content;
        }

      private:
        std::size_t bytes() const { return size_ * sizeof(T); }

        T* first_ = nullptr;
        std::size_t size_;
    };

    struct measured {
        std::uint64_t atomics;
        double milliseconds = 0;
    };

    /// Runs `kernel(w, first)` for all its lanes and counts.
    template <class Kernel>
    static measured run(const Kernel& kernel) {
        array<unsigned long long> atomics(1);
        start(counting_warp{{}, atomics.data()}, kernel);
        return {atomics.download()[0]};
    }

    /// Median over rounds in which the two kernels take turns; the first round warms up.
    template <class T, class A, class B>
    static void time(array<T>& result, const A& a, measured& of_a, const B& b, measured& of_b) {
        constexpr int rounds = 9;
        std::vector<double> ms_a, ms_b;
        for (int round = -1; round < rounds; ++round) {
            result.zero();
            const double once_a = milliseconds(a);
            result.zero();
            const double once_b = milliseconds(b);
            if (round < 0) continue;
            ms_a.push_back(once_a);
            ms_b.push_back(once_b);
        }
        of_a.milliseconds = median(ms_a);
        of_b.milliseconds = median(ms_b);
    }

    static void print_cost(const measured& first, const measured& m) {
        std::printf("%.3f | %.2fx |\n", m.milliseconds, first.milliseconds / m.milliseconds);
    }

  private:
    static double median(std::vector<double> v) {
        std::sort(v.begin(), v.end());
        return v[v.size() / 2];
    }

    template <class W, class Kernel>
    static void start(const W& w, const Kernel& kernel) {
        constexpr unsigned block = 256;
        launch<<<(kernel.lanes() + block - 1) / block, block>>>(w, kernel);
        check(cudaGetLastError());
    }

    template <class Kernel>
    static double milliseconds(const Kernel& kernel) {
        static const stopwatch watch;
        check(cudaEventRecord(watch.from));
        start(warpagg::cuda_warp{}, kernel);
        check(cudaEventRecord(watch.to));
        check(cudaEventSynchronize(watch.to));
        float ms = 0;
        check(cudaEventElapsedTime(&ms, watch.from, watch.to));
        return static_cast<double>(ms);
    }

    struct stopwatch {
        cudaEvent_t from{}, to{};
        stopwatch() {
            check(cudaEventCreate(&from));
            check(cudaEventCreate(&to));
        }
    };
};

}  // namespace example
