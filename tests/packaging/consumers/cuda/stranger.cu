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
    return totals[0] == n && totals[1] == n / 2 ? 0 : 1;
}
