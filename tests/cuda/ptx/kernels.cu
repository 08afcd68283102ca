// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// What test_ptx.cpp counts the instructions of.
#include <warpagg/atomic.hpp>

using warpagg::policy;

namespace {

/// Nine values a lane, which no other lane has.
struct nine {
    float v[9];
    __device__ explicit nine(const float* from) {
        for (int i = 0; i < 9; ++i) v[i] = from[9 * (blockIdx.x * blockDim.x + threadIdx.x) + i];
    }
};

template <class Policy>
__device__ __forceinline__ void once(float* to, const float* from, unsigned n) {
    const nine values(from);
    warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, to, values.v, threadIdx.x < n, Policy{});
}

/// The flag does not change within the loop, which invites the compiler to split it in two.
template <class Policy>
__device__ __forceinline__ void looped(float* to, const float* from, unsigned n) {
    const warpagg::cuda_warp w;
    const bool active = w.lane() < n;
    nine values(from);
    for (unsigned step = 0; step < 2048; ++step) {
        for (float& v : values.v) v += 1.0f;
        warpagg::warp_reduce_atomic(w, to + 12 * step, values.v, active, Policy{});
    }
}

}  // namespace

using scatter = policy<warpagg::reduce::scatter>;
using shfl_down = policy<warpagg::reduce::shfl_down>;
using butterfly = policy<warpagg::reduce::butterfly>;
using per_lane = policy<warpagg::reduce::per_lane>;

#define WARPAGG_TEST_KERNEL(name, body) \
    extern "C" __global__ void name(float* to, const float* from, unsigned n) { body(to, from, n); }
WARPAGG_TEST_KERNEL(scatter_once, once<scatter>)
WARPAGG_TEST_KERNEL(scatter_looped, looped<scatter>)
WARPAGG_TEST_KERNEL(shfl_down_once, once<shfl_down>)
WARPAGG_TEST_KERNEL(shfl_down_looped, looped<shfl_down>)
WARPAGG_TEST_KERNEL(butterfly_once, once<butterfly>)
WARPAGG_TEST_KERNEL(butterfly_looped, looped<butterfly>)
WARPAGG_TEST_KERNEL(per_lane_once, once<per_lane>)

extern "C" __global__ void members(float* to, const float* from, unsigned n) {
    const warpagg::cuda_warp w;
    const unsigned lane = w.lane();
    const bool active = lane < n;
    float v = w.load(from, lane, active) + w.load_row(from, 64, active);
    v += w.shfl(v, lane / 2);
    v += w.shfl_down(v, 16);
    v += w.shfl_xor(v, 8);
    v *= static_cast<float>(w.match(static_cast<unsigned>(v)));
    if (w.any(v > 1.0f)) v *= static_cast<float>(w.ballot(v > 2.0f));
    w.store(to, lane + 32, v, active);
    w.store_row(to, 64, v, active);
    w.atomic(
        warpagg::operation::sum{}, [=](unsigned i) { return to + i; }, lane, v, active);
}

__device__ __forceinline__ unsigned lane_id() {
    unsigned id;
    asm("mov.u32 %0, %%laneid;" : "=r"(id));
    return id;
}

extern "C" __global__ void by_hand(float* to, const float* from, unsigned n) {
    constexpr unsigned all = 0xffffffff;
    const unsigned lane = lane_id();
    const bool active = lane < n;
    float v = (active ? from[lane] : 0.0f) + (active ? from[64l + lane_id()] : 0.0f);
    v += __shfl_sync(all, v, lane / 2);
    v += __shfl_down_sync(all, v, 16);
    v += __shfl_xor_sync(all, v, 8);
    v *= static_cast<float>(__match_any_sync(all, static_cast<unsigned>(v)));
    if (__any_sync(all, v > 1.0f)) v *= static_cast<float>(__ballot_sync(all, v > 2.0f));
    if (active) to[lane + 32] = v;
    if (active) to[64l + lane_id()] = v;
    if (active) atomicAdd(to + lane, v);
}
