// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What a call of warp_reduce_atomic costs by policy, by the number of values and by how many lanes are
/// active: the figures behind `default_policy`. Warps add to records at random, as the backward pass of
/// splatting does.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>
#include <warpagg/atomic.hpp>

namespace {

using namespace warpagg;

constexpr unsigned records = 1u << 20, blocks = 132 * 16, threads = 128, steps_per_warp = 2048;
constexpr unsigned seed = 12345;
constexpr int rounds = 7;

void check(cudaError_t status) {
    if (status != cudaSuccess) throw std::runtime_error(cudaGetErrorString(status));
}

template <class Policy, int N>
__global__ void add(float* memory, unsigned active_lanes) {
    const cuda::warp w;
    const bool active = w.lane() < active_lanes;
    std::uint32_t random = seed ^ ((blockIdx.x * blockDim.x + threadIdx.x) / 32 * 747796405u);
    float values[N];
    for (int i = 0; i < N; ++i) values[i] = static_cast<float>(w.lane() + static_cast<unsigned>(i));
    for (unsigned step = 0; step < steps_per_warp; ++step) {
        random = random * 1664525u + 1013904223u;
        for (int i = 0; i < N; ++i) values[i] += 1.0f;  // no two steps add the same
        warp_reduce_atomic<float, N>(w, memory + std::size_t{random >> 12} * ((N + 3) / 4 * 4), values,
                                     active, Policy{});
    }
}

class stopwatch {
  public:
    stopwatch() {
        check(cudaEventCreate(&from_));
        check(cudaEventCreate(&to_));
    }
    template <class F>
    double milliseconds(const F& f) {
        check(cudaEventRecord(from_));
        f();
        check(cudaGetLastError());
        check(cudaEventRecord(to_));
        check(cudaEventSynchronize(to_));
        float ms = 0;
        check(cudaEventElapsedTime(&ms, from_, to_));
        return static_cast<double>(ms);
    }

  private:
    cudaEvent_t from_{}, to_{};
};

struct row {
    const char* policy;
    std::vector<double> ms;
};

template <int N>
void bench(float* memory, unsigned active, nlohmann::ordered_json& out) {
    row rows[] = {
        {"per_lane", {}}, {"shfl_down", {}}, {"butterfly, contiguous", {}}, {"scatter", {}}, {"default", {}}};
    stopwatch watch;
    for (int round = -1; round < rounds; ++round) {  // the first warms up; the policies take turns
        const double ms[] = {
            watch.milliseconds(
                [&] { add<policy<reduce::per_lane>, N><<<blocks, threads>>>(memory, active); }),
            watch.milliseconds(
                [&] { add<policy<reduce::shfl_down>, N><<<blocks, threads>>>(memory, active); }),
            watch.milliseconds([&] {
                add<policy<reduce::butterfly, commit::contiguous>, N><<<blocks, threads>>>(memory, active);
            }),
            watch.milliseconds([&] { add<policy<reduce::scatter>, N><<<blocks, threads>>>(memory, active); }),
            watch.milliseconds(
                [&] { add<default_policy<float, N>, N><<<blocks, threads>>>(memory, active); })};
        if (round < 0) continue;
        for (std::size_t i = 0; i < std::size(rows); ++i) rows[i].ms.push_back(ms[i]);
    }
    std::printf("| %d | %u |", N, active);
    for (row& r : rows) {
        std::ranges::sort(r.ms);
        std::printf(" %.2f |", r.ms[rounds / 2]);
        out.push_back({{"n", N},
                       {"active", active},
                       {"policy", r.policy},
                       {"ms", r.ms[rounds / 2]},
                       {"ms_least", r.ms.front()},
                       {"ms_most", r.ms.back()}});
    }
    std::printf("\n");
}

template <int... N>
void bench_all(float* memory, nlohmann::ordered_json& out) {
    for (const unsigned active : {32u, 16u, 5u, 1u}) (bench<N>(memory, active, out), ...);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        cudaDeviceProp gpu{};
        check(cudaGetDeviceProperties(&gpu, 0));
        int driver = 0;
        check(cudaDriverGetVersion(&driver));
        nlohmann::ordered_json json{{"bench", "atomics"},
                                    {"gpu", gpu.name},
                                    {"driver_api", driver},
                                    {"nvcc", WARPAGG_NVCC},
                                    {"commit", WARPAGG_COMMIT},
                                    {"seed", seed},
                                    {"warp_steps", std::uint64_t{blocks} * (threads / 32) * steps_per_warp},
                                    {"records", records},
                                    {"rounds", rounds}};
        float* memory = nullptr;
        check(cudaMalloc(&memory, sizeof(float) * 32 * records));
        check(cudaMemset(memory, 0, sizeof(float) * 32 * records));
        std::printf(
            "| N | active | per_lane | shfl_down | butterfly, contiguous | scatter | default |\n"
            "| --- | --- | --- | --- | --- | --- | --- |\n");
        bench_all<1, 2, 3, 4, 8, 9, 16, 24, 32>(memory, json["rows"]);
        check(cudaFree(memory));
        if (argc > 1) std::ofstream(argv[1]) << json.dump(1) << '\n';
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
