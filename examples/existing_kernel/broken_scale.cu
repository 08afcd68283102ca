// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cuda_runtime.h>

/// Divides the values of each block by the sum of their magnitudes.
__global__ void scale(const float* __restrict__ values, int n, float* __restrict__ scaled) {
    extern __shared__ float sums[];
    const int rank = threadIdx.x, i = blockIdx.x * blockDim.x + rank;
    sums[rank] = fabsf(values[i]);
    __syncthreads();

    for (int half = blockDim.x / 2; half > 0; half /= 2) {
        if (rank < half) sums[rank] += sums[rank + half];
        __syncthreads();
    }
    if (i < n) scaled[i] = values[i] / sums[0];
}
