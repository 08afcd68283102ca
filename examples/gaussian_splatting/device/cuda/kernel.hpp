// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What the kernels of `cuda` share.
namespace gs::device::detail {

/// The first thing that every kernel does. Its blocks may have been sent to the processors as soon as those
/// of the kernel before it had all begun, so that they are there when it ends: here they wait for its end.
__device__ inline void await_kernel_before() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.launch_dependents;");
    asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

inline constexpr unsigned warp_size = 32, every_lane = 0xffffffffu;

__device__ inline unsigned lane_of_warp() { return threadIdx.x % warp_size; }
/// How many of these lanes come before this one.
__device__ inline unsigned lanes_before(unsigned lanes) {
    return static_cast<unsigned>(__popc(lanes & ((1u << lane_of_warp()) - 1)));
}
/// Whether this one is the last of them.
__device__ inline bool is_last_of(unsigned lanes) { return lanes >> lane_of_warp() == 1; }

/// The sum over the lanes up to and with this one.
template <class T>
__device__ T sum_to_lane(T x) {
    for (unsigned d = 1; d < warp_size; d *= 2) {
        const T before = __shfl_up_sync(every_lane, x, d);
        if (lane_of_warp() >= d) x += before;
    }
    return x;
}

/// The sum over the threads of a block up to and with this one. `sums`: shared, one a warp, not used by
/// anyone since the last barrier. All threads call together.
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
