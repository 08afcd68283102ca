// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Compiles if WARPAGG_OLD_CUDA_NAME brings back the former name of `cuda_warp`, and its former header.
#define WARPAGG_OLD_CUDA_NAME
#include <cstdio>
#include <warpagg/atomic.hpp>
#include <warpagg/simt/cuda.hpp>

__global__ void sum(unsigned* totals) {
    warpagg::cuda::warp w;
    const unsigned values[2] = {1, threadIdx.x};
    const bool active = threadIdx.x % 3 == 0;  // a lane may have nothing to add
    warpagg::warp_reduce_atomic(w, totals, values, active);
}

int main() {
    unsigned *totals, host[2];
    cudaMalloc(&totals, sizeof host);
    cudaMemset(totals, 0, sizeof host);
    sum<<<4096, 256>>>(totals);
    cudaMemcpy(host, totals, sizeof host, cudaMemcpyDeviceToHost);
    std::printf("%u lanes added %u\n", host[0], host[1]);
}
