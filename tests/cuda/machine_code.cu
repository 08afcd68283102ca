// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Kernels whose machine code check_machine_code.py examines.
#include <cuda_bf16.h>
#include <cuda_fp16.h>

#include "../../bench/kernels/blending_kernel.hpp"

using warpagg::policy;

namespace {

template <class T>
__device__ __forceinline__ void add_two(T* to, const T* from, unsigned n) {
    const T values[2] = {from[2 * threadIdx.x], from[2 * threadIdx.x + 1]};
    warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, to, values, threadIdx.x < n);
}

}  // namespace

extern "C" __global__ void pairs_of_half(__half2* to, const __half2* from, unsigned n) {
    add_two(to, from, n);
}
extern "C" __global__ void pairs_of_bfloat16(__nv_bfloat162* to, const __nv_bfloat162* from, unsigned n) {
    add_two(to, from, n);
}
extern "C" __global__ void pairs_of_half_by_key(__half2* to, const __half2* from, const unsigned* key) {
    const __half2 values[1] = {from[threadIdx.x]};
    warpagg::warp_match_reduce_atomic(warpagg::cuda_warp{}, to, key[threadIdx.x], values, true);
}

namespace {
template __global__ void backward<32>(frame, to_arrays<policy<>, 38>);
template __global__ void backward<32>(frame, to_record<policy<>, 38>);
template __global__ void backward<32>(frame, to_arrays<policy<warpagg::reduce::scatter>, 38>);
template __global__ void backward<3>(frame, to_arrays<policy<>, 9>);
}  // namespace
