// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Compiles if WARPAGG_OLD_CUDA_NAME brings back the former name of `cuda_warp`.
#define WARPAGG_OLD_CUDA_NAME
#include <warpagg/atomic.hpp>

__global__ void sum(unsigned* totals) {
    warpagg::cuda::warp w;
    const unsigned values[2] = {1, threadIdx.x};
    warpagg::warp_reduce_atomic(w, totals, values, threadIdx.x % 3 == 0);
}
