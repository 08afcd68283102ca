// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <warpagg/atomic.hpp>

/// Counts all numbers, and the odd ones among them.
__global__ void count(const unsigned* numbers, unsigned n, unsigned* totals) {
    const warpagg::cuda_warp warp;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const bool active = i < n;
    const unsigned values[2] = {1, active ? numbers[i] % 2 : 0};
    warpagg::warp_reduce_atomic(warp, totals, values, active);
}

/// Adds, for each bin, the number of samples and the sum of their weights.
__global__ void weighted_histogram(const unsigned* bin, const float* weight, unsigned n, float* sums,
                                   unsigned bins) {
    const warpagg::cuda_warp warp;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const bool active = i < n && bin[i] < bins;
    const unsigned key = active ? bin[i] : 0;
    const float values[2] = {1.0f, active ? weight[i] : 0.0f};
    warpagg::warp_match_reduce_atomic(warp, sums, key, values, active);
}

int main() {
    constexpr unsigned n = 1000;
    unsigned host[n], totals[2] = {}, *numbers, *device_totals;
    for (unsigned i = 0; i < n; ++i) host[i] = i * i;
    if (cudaMalloc(&numbers, sizeof host) != cudaSuccess) {
        std::puts("skipped: there is no GPU to run on");
        return 77;
    }
    cudaMalloc(&device_totals, sizeof totals);
    cudaMemcpy(numbers, host, sizeof host, cudaMemcpyHostToDevice);
    cudaMemcpy(device_totals, totals, sizeof totals, cudaMemcpyHostToDevice);
    count<<<(n + 127) / 128, 128>>>(numbers, n, device_totals);
    cudaMemcpy(totals, device_totals, sizeof totals, cudaMemcpyDeviceToHost);
    std::printf("%u numbers, %u odd\n", totals[0], totals[1]);
    if (totals[0] != n || totals[1] != n / 2) return 1;

    constexpr unsigned bins = 100;  // of the numbers, only the squares of 0 to 9 have a bin
    float weights[n], sums[2 * bins] = {}, *device_weights, *device_sums;
    for (float& weight : weights) weight = 0.5f;
    cudaMalloc(&device_weights, sizeof weights);
    cudaMalloc(&device_sums, sizeof sums);
    cudaMemcpy(device_weights, weights, sizeof weights, cudaMemcpyHostToDevice);
    cudaMemcpy(device_sums, sums, sizeof sums, cudaMemcpyHostToDevice);
    weighted_histogram<<<(n + 127) / 128, 128>>>(numbers, device_weights, n, device_sums, bins);
    cudaMemcpy(sums, device_sums, sizeof sums, cudaMemcpyDeviceToHost);
    return sums[0] == 1 && sums[2 * 81] == 1 && sums[2 * 81 + 1] == 0.5f && sums[2 * 82] == 0 ? 0 : 1;
}
