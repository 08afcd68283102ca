// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The backward pass of a multiresolution hash grid: a thread per point and level adds its gradient to
/// the 8 corners of the point's cell. Source: Müller et al., "Instant Neural Graphics Primitives with a
/// Multiresolution Hash Encoding" (2022), section 3.

#include <cuda_fp16.h>

#include <memory>
#include <random>
#include <warpagg/atomic.hpp>

#include "kernel.hpp"

namespace {

namespace reduce = warpagg::reduce;
namespace gate = warpagg::gate;
using warpagg::policy;

constexpr unsigned levels = 16, log2_entries = 19, entries = 1u << log2_entries, threads = 256;
constexpr float coarsest = 16, growth = 1.4472692f;

/// Two features of a grid point, as two floats or as a pair of 16-bit floats.
struct two_floats {
    using type = float;
    static constexpr int count = 2;
    __device__ static void weigh(float2 grad, float weight, float (&v)[2]) {
        v[0] = weight * grad.x;
        v[1] = weight * grad.y;
    }
};
struct half_pair {
    using type = __half2;
    static constexpr int count = 1;
    __device__ static void weigh(float2 grad, float weight, __half2 (&v)[1]) {
        v[0] = __floats2half2_rn(weight * grad.x, weight * grad.y);
    }
};

__device__ unsigned entry_of(uint3 at, unsigned cells) {
    const unsigned long long all = 1ull * (cells + 1) * (cells + 1) * (cells + 1);
    if (all <= entries) return at.x + (cells + 1) * (at.y + (cells + 1) * at.z);
    return (at.x ^ (at.y * 2654435761u) ^ (at.z * 805459861u)) & (entries - 1);
}

template <class Features, class Add>
__global__ void __launch_bounds__(threads) backward(unsigned points, const float3* point, const float2* grad,
                                                    typename Features::type* table, Add add) {
    const warpagg::cuda_warp w;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x, level = blockIdx.y;
    const bool active = i < points;
    const float3 p = active ? point[i] : float3{};
    const float2 g = active ? grad[i * levels + level] : float2{};
    const float scale = coarsest * __powf(growth, static_cast<float>(level));
    const auto cells = static_cast<unsigned>(scale);
    const float3 x{p.x * scale, p.y * scale, p.z * scale};
    const uint3 cell{min(static_cast<unsigned>(x.x), cells - 1), min(static_cast<unsigned>(x.y), cells - 1),
                     min(static_cast<unsigned>(x.z), cells - 1)};
    const float3 part{x.x - static_cast<float>(cell.x), x.y - static_cast<float>(cell.y),
                      x.z - static_cast<float>(cell.z)};
    auto* const base = table + std::size_t{level} * entries * Features::count;
#pragma unroll
    for (unsigned corner = 0; corner < 8; ++corner) {
        const bool dx = corner & 1, dy = corner & 2, dz = corner & 4;
        const float weight =
            (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y) * (dz ? part.z : 1 - part.z);
        const unsigned key = entry_of({cell.x + dx, cell.y + dy, cell.z + dz}, cells);
        typename Features::type v[Features::count];
        Features::weigh(g, weight, v);
        add(w, base, key, v, active);
    }
}

struct plain_atomics {
    template <class T, int N>
    __device__ void operator()(warpagg::cuda_warp, T* base, unsigned key, const T (&v)[N],
                               bool active) const {
        if (!active) return;
        for (int i = 0; i < N; ++i) atomicAdd(base + std::size_t{key} * N + i, v[i]);
    }
};
template <class Policy>
struct by_key {
    template <class T, int N>
    __device__ void operator()(warpagg::cuda_warp w, T* base, unsigned key, const T (&v)[N],
                               bool active) const {
        warpagg::warp_match_reduce_atomic(w, base, key, v, active, Policy{});
    }
};

struct points {
    device_array<float3> at;
    device_array<float2> grad;
};

/// Random points, or the samples of rays: neighbors in memory are then neighbors in space.
std::shared_ptr<const points> draw(unsigned count, bool on_rays) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    constexpr unsigned samples = 128;
    std::vector<float3> at;
    float3 from{}, to{};
    for (unsigned i = 0; i < count; ++i) {
        if (!on_rays) {
            at.push_back({unit(random), unit(random), unit(random)});
            continue;
        }
        if (i % samples == 0) {
            from = {unit(random), unit(random), 0};
            to = {unit(random), unit(random), 1};
        }
        const float t = (static_cast<float>(i % samples) + unit(random)) / samples;
        at.push_back({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), t});
    }
    std::vector<float2> grad(std::size_t{count} * levels);
    for (float2& g : grad) g = {1.0f / 64 * unit(random), 1.0f / 64 * unit(random)};
    return std::shared_ptr<const points>(new points{device_array(at), device_array(grad)});
}

template <class Features>
kernel_case with_features(const char* kernel, const char* input, bool on_rays) {
    using T = typename Features::type;
    constexpr unsigned count = 1u << 18;
    const auto in = draw(count, on_rays);
    const auto table = std::make_shared<device_array<T>>(std::size_t{levels} * entries * Features::count);
    // Large sums of 16-bit floats lose small terms, more of them if terms are not combined first.
    const double tolerance = std::is_same_v<T, float> ? 1e-3 : 0.5;
    kernel_case of{kernel, input, {}, {}, {}, tolerance};
    const auto variant = [&]<class Add>(const char* name, Add add) {
        of.variants.push_back({name, [in, table, add] {
                                   backward<Features><<<dim3(count / threads, levels), threads>>>(
                                       count, in->at.data(), in->grad.data(), table->data(), add);
                               }});
    };
    variant("plain atomics", plain_atomics{});
    variant("default", by_key<policy<>>{});
    variant("per_lane", by_key<policy<reduce::per_lane>>{});
    variant("always", by_key<policy<gate::always>>{});
    of.clear = [table] { check(cudaMemset(table->data(), 0, table->size() * sizeof(T))); };
    of.result = [table] {
        const auto all = table->to_host();
        if constexpr (std::is_same_v<T, float>) {
            return all;
        } else {
            std::vector<float> sums;
            for (const T& v : all) {
                sums.push_back(__low2float(v));
                sums.push_back(__high2float(v));
            }
            return sums;
        }
    };
    return of;
}

}  // namespace

std::vector<kernel_maker> hash_grid_cases() {
    std::vector<kernel_maker> all;
    for (const bool on_rays : {false, true}) {
        const char* const input = on_rays ? "points on rays" : "random points";
        all.push_back([=] { return with_features<two_floats>("hash grid, 2 floats", input, on_rays); });
        all.push_back([=] { return with_features<half_pair>("hash grid, half2", input, on_rays); });
    }
    return all;
}
