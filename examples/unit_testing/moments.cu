// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "moments.hpp"

__global__ void moments_kernel(const float* samples, unsigned n, float* moments) {
    add_moments(warpagg::cuda_warp{}, blockIdx.x * blockDim.x + threadIdx.x, samples, n, moments);
}
