// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Launches one warp that keeps the rules, or breaks one of them, with WARPAGG_CHECKS: the argument says
/// which. A kernel that traps takes its process with it, hence a process for each.

#define WARPAGG_CHECKS

#include <cstdio>
#include <string>
#include <warpagg/atomic.hpp>

namespace {

/// Lane i adds to the record at `i * step`, if its number is below `active`.
__global__ void add(float* memory, unsigned step, unsigned active) {
    const warpagg::cuda_warp w;
    const float v[2] = {1.0f, 2.0f};
    warpagg::warp_reduce_atomic(w, memory + w.lane() * step, v, w.lane() < active,
                                warpagg::policy{warpagg::assume_busy});
}
/// The same by keys: all lanes have key 0.
__global__ void add_by_key(float* memory, unsigned step, unsigned active) {
    const warpagg::cuda_warp w;
    const float v[2] = {1.0f, 2.0f};
    warpagg::warp_match_reduce_atomic(w, memory + w.lane() * step, 0u, v, w.lane() < active,
                                      warpagg::policy{warpagg::assume_busy});
}

bool succeeds(cudaError_t result) {
    if (result == cudaSuccess) return true;
    std::printf("%s\n", cudaGetErrorString(result));
    return false;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string misuse = argc > 1 ? argv[1] : "";
    float* memory = nullptr;
    if (!succeeds(cudaMalloc(reinterpret_cast<void**>(&memory), 64 * sizeof(float)))) return 1;
    if (!succeeds(cudaMemset(memory, 0, 64 * sizeof(float)))) return 1;

    add<<<1, 32>>>(memory, misuse == "destination" ? 2 : 0, misuse == "idle" ? 0 : 9);
    add_by_key<<<1, 32>>>(memory, misuse == "base" ? 2 : 0, misuse == "idle_by_key" ? 0 : 9);
    if (!succeeds(cudaDeviceSynchronize())) return 1;

    float sums[2];
    if (!succeeds(cudaMemcpy(sums, memory, sizeof sums, cudaMemcpyDeviceToHost))) return 1;
    std::printf("sums: %g %g\n", static_cast<double>(sums[0]), static_cast<double>(sums[1]));
    return 0;
}
