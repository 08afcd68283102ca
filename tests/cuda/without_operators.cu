// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Compiles if the library needs no operators and no conversions of 16-bit floats. PyTorch removes
// them from every extension, by the macros that this test is compiled with.
#include <cuda_bf16.h>
#include <cuda_fp16.h>

#include <warpagg/atomic.hpp>

using namespace warpagg;

template <class T>
__device__ void add(T* sums, unsigned key, T value) {
    const cuda_warp w;
    const T one[1] = {value}, three[3] = {value, value, value};
    warp_reduce_atomic(w, sums, one, true);
    warp_reduce_atomic(w, sums, three, true);
    warp_reduce_atomic(w, sums, three, true, policy{shfl_down, scalar});
    warp_reduce_atomic(w, sums, three, true, policy{per_lane});
    warp_match_reduce_atomic(w, sums, key, one, true);
    warp_match_reduce_atomic(w, sums, key, three, true);
}

__global__ void add_all(__half* halves, __nv_bfloat16* bfloats, __half2* half_pairs,
                        __nv_bfloat162* bfloat_pairs, const unsigned* keys) {
    add(halves, keys[threadIdx.x], halves[threadIdx.x]);
    add(bfloats, keys[threadIdx.x], bfloats[threadIdx.x]);
    add(half_pairs, keys[threadIdx.x], half_pairs[threadIdx.x]);
    add(bfloat_pairs, keys[threadIdx.x], bfloat_pairs[threadIdx.x]);
}
