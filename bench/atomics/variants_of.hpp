// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// The kernels of bench_atomics for one number of values.

#include <cuda_bf16.h>
#include <cuda_fp16.h>

#include <type_traits>
#include <warpagg/atomic.hpp>
#include <warpagg/reduce/cooperative.hpp>
#include <warpagg/reduce/cub.hpp>

#include "variants.hpp"

namespace {

namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
using warpagg::policy;

/// Does not accumulate; measures the rest of a step.
struct nothing {};

__device__ inline std::uint32_t next(std::uint32_t& random) {
    return random = random * 1664525u + 1013904223u;
}

/// Warps add to records at random, as the backward pass of splatting does.
template <class T, int N, class Policy>
__global__ void add(T* memory, activity lanes) {
    const warpagg::cuda_warp w;
    const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t chance = w.lane() < lanes.count ? 0xffffffffu : lanes.chance;
    std::uint32_t record = seed ^ (thread / 32 * 747796405u), lane = seed ^ (thread * 2891336453u);
    T values[N], one{};
    if constexpr (std::is_arithmetic_v<T>) {
        one = T(1);
    } else {
        one.x = one.y = 1.0f;
    }
    for (int i = 0; i < N; ++i) values[i] = memory[w.lane() + i];  // otherwise the compiler finds them equal
    for (unsigned step = 0; step < steps_per_warp; ++step) {
        next(record);
        const bool active = next(lane) < chance;
        for (int i = 0; i < N; ++i) values[i] += one;  // no two steps add the same
        T* const to = memory + std::size_t{record >> 12} * ((N + 3) / 4 * 4);
        if constexpr (!std::is_same_v<Policy, nothing>)
            warpagg::warp_reduce_atomic(w, to, values, active, Policy{});
    }
    if constexpr (std::is_same_v<Policy, nothing>) {
        for (int i = 0; i < N; ++i)
            if (record + lane == seed) memory[i] = values[i];
    }
}

template <class T, int N, class Policy, bool Aligned>
void launch(void* memory, activity lanes) {
    add<T, N, Policy><<<blocks, threads>>>(static_cast<T*>(memory) + (Aligned ? 0 : 1), lanes);
}

template <class T, int N>
void register_type(const char* type) {
    const auto one = [&]<class Policy>(const char* name, Policy) {
        variants().push_back({type, N, name, true, launch<T, N, Policy, true>});
    };
    one("nothing", nothing{});
    one("per_lane", policy<reduce::per_lane>{});
    one("shfl_down", policy<reduce::shfl_down>{});
    one("butterfly", policy<reduce::butterfly>{});
    one("scatter", policy<reduce::scatter>{});
    one("default", policy<>{});
    if constexpr (std::is_same_v<T, int> || std::is_same_v<T, unsigned>)
        one("redux", policy<reduce::redux>{});
    if constexpr (std::is_same_v<T, float>) {
        variants().push_back({type, N, "default", false, launch<T, N, policy<>, false>});
        one("per_lane, packed<4>", policy<reduce::per_lane, commit::packed<4>>{});
        one("shfl_down, packed<4>", policy<reduce::shfl_down, commit::packed<4>>{});
        one("cub", policy<reduce::cub>{});
        one("cooperative, scalar", policy<reduce::cooperative, commit::scalar>{});
    }
}

template <int N>
void register_all() {
    register_type<float, N>("float");
    if constexpr (N == 1 || N == 2 || N == 4 || N == 9 || N == 16 || N == 32) {
        register_type<double, N>("double");
        register_type<unsigned, N>("unsigned");
        register_type<long long, N>("int64");
        register_type<__half2, N>("half2");
    }
}

}  // namespace
