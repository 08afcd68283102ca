// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Functions that the kernels of `cuda` share.
namespace gs::device::detail {

/// Waits until the previous kernel has ended. Each kernel calls this first. On compute capability
/// 9.0 and later, its blocks may be launched as soon as all blocks of the previous kernel have
/// begun, which hides the latency of launches.
__device__ inline void await_kernel_before() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.launch_dependents;");
    asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

inline constexpr unsigned warp_size = 32, every_lane = 0xffffffffu;

__device__ inline unsigned lane_of_warp() { return threadIdx.x % warp_size; }
/// Returns how many of these lanes precede the calling lane.
__device__ inline unsigned lanes_before(unsigned lanes) {
    return static_cast<unsigned>(__popc(lanes & ((1u << lane_of_warp()) - 1)));
}
/// Returns whether the calling lane is the last of these lanes.
__device__ inline bool is_last_of(unsigned lanes) { return lanes >> lane_of_warp() == 1; }

/// Returns the sum of x over the lanes up to and including the calling lane.
template <class T>
__device__ T sum_to_lane(T x) {
    for (unsigned d = 1; d < warp_size; d *= 2) {
        const T before = __shfl_up_sync(every_lane, x, d);
        if (lane_of_warp() >= d) x += before;
    }
    return x;
}

/// Returns the sum of x over the threads of a block up to and including the calling thread. All
/// threads call this. `sums` is shared memory for one value per warp, which no thread has accessed
/// since the last barrier.
template <unsigned Warps, class T>
__device__ T sum_to_thread(T x, T* sums) {
    static_assert(Warps <= warp_size);
    x = sum_to_lane(x);
    const unsigned warp = threadIdx.x / warp_size;
    if (lane_of_warp() == warp_size - 1) sums[warp] = x;
    __syncthreads();
    for (unsigned w = 0; w < warp; ++w) x += sums[w];
    return x;
}

}  // namespace gs::device::detail
