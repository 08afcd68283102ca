// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Kernels that use each part of the library on the HIP model. They are compiled for the GPU, and not run.

// The part of HIP's headers that is needed. Clang compiles HIP without them.
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#define __forceinline__ inline __attribute__((always_inline))
extern "C" __device__ void* memcpy(void*, const void*, __SIZE_TYPE__);

#include <warpagg/match_reduce_atomic.hpp>
#include <warpagg/segmented_sum.hpp>

#include "hip_warp.hpp"

using namespace warpagg;

template <int N, class T, class Policy>
__device__ void add(T* to, const T* from, unsigned n, Policy how) {
    const hip_warp w;
    T values[N];
    for (int i = 0; i < N; ++i) values[i] = from[w.lane() * N + static_cast<unsigned>(i)];
    warp_reduce_atomic(w, to, values, w.lane() < n, how);
}

__global__ void sums(float* to, const float* from, unsigned n) {
    add<9>(to, from, n, policy{});
    add<1>(to, from, n, policy{shfl_down});
    add<3>(to, from, n, policy{butterfly, at_least<5>});
}
__global__ void largest(int* to, const int* from, unsigned n) { add<2>(to, from, n, policy{maximum}); }
__global__ void exact_sums(accumulator<accumulate::exact>* to, const float* from, unsigned n) {
    const hip_warp w;
    const float values[1] = {from[w.lane()]};
    warp_reduce_atomic(w, to, values, w.lane() < n, policy{exact});
}
__global__ void sums_by_key(float* to, const unsigned* keys, const float* from) {
    const hip_warp w;
    const float values[1] = {from[w.lane()]};
    if (skip_if_warp_idle(w, keys[w.lane()] != 0)) return;
    warp_match_reduce_atomic(w, to, keys[w.lane()], values, keys[w.lane()] != 0);
}
__global__ void tiles(segmented_sum_tiles<float> sum) { sum(hip_warp{}, 0); }
