// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Sums of rows by key, as in the scatter and segment operations of graph networks.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <warpagg/atomic.hpp>

#include "kernel.hpp"

namespace {

namespace reduce = warpagg::reduce;
using warpagg::policy;

constexpr unsigned threads = 256;

/// A thread adds `Each` neighboring floats of a row of `Width`.
template <int Width, int Each, class Add>
__global__ void __launch_bounds__(threads)
    scatter(unsigned rows, const unsigned* key, const float* values, float* sums, Add add) {
    const warpagg::cuda_warp w;
    constexpr unsigned parts = Width / Each;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const bool active = i < rows * parts;
    const unsigned part = active ? key[i / parts] * parts + i % parts : 0;
    float v[Each];
    if constexpr (Each == 4) {
        const float4 f = active ? reinterpret_cast<const float4*>(values)[i] : float4{};
        v[0] = f.x, v[1] = f.y, v[2] = f.z, v[3] = f.w;
    } else {
        v[0] = active ? values[i] : 0;
    }
    add(w, sums, part, v, active);
}

struct plain_atomics {
    template <int N>
    __device__ void operator()(warpagg::cuda_warp, float* base, unsigned key, const float (&v)[N],
                               bool active) const {
        if (!active) return;
        for (int i = 0; i < N; ++i) atomicAdd(base + std::size_t{key} * N + i, v[i]);
    }
};
template <class Policy>
struct by_key {
    template <int N>
    __device__ void operator()(warpagg::cuda_warp w, float* base, unsigned key, const float (&v)[N],
                               bool active) const {
        warpagg::warp_match_reduce_atomic(w, base, key, v, active, Policy{});
    }
};

enum class keys { uniform, zipf, sorted };

std::vector<unsigned> draw_keys(keys how, unsigned rows, unsigned segments) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<unsigned> all;
    for (unsigned i = 0; i < rows; ++i)  // Zipf: the k-th most frequent key has a share of about 1 / k
        all.push_back(how == keys::zipf
                          ? static_cast<unsigned>(std::exp(unit(random) * std::log(segments))) - 1
                          : static_cast<unsigned>(unit(random) * segments));
    if (how == keys::sorted) std::ranges::sort(all);
    return all;
}

template <int Width>
kernel_case with_rows_of(keys how, const char* input) {
    constexpr unsigned rows = (1u << 22) / (Width < 4 ? 1 : Width / 4), segments = rows / 16;
    const auto key = std::make_shared<const device_array<unsigned>>(draw_keys(how, rows, segments));
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> host(std::size_t{rows} * Width);
    for (float& v : host) v = unit(random);
    const auto values = std::make_shared<const device_array<float>>(host);
    const auto sums = std::make_shared<device_array<float>>(std::size_t{segments} * Width);
    kernel_case of{"scatter, rows of " + std::to_string(Width), input, {}, {}, {}};
    const auto variant = [&]<int Each, class Add>(const char* name, std::integral_constant<int, Each>,
                                                  Add add) {
        of.variants.push_back({name, [key, values, sums, add] {
                                   constexpr unsigned all = rows * (Width / Each);
                                   scatter<Width, Each><<<(all + threads - 1) / threads, threads>>>(
                                       rows, key->data(), values->data(), sums->data(), add);
                               }});
    };
    constexpr std::integral_constant<int, 1> one;
    variant("plain atomics", one, plain_atomics{});
    variant("default, 1 value per lane", one, by_key<policy<>>{});
    if constexpr (Width >= 4) {
        constexpr std::integral_constant<int, 4> four;
        variant("default", four, by_key<policy<>>{});
        variant("per_lane", four, by_key<policy<reduce::per_lane>>{});
        variant("per_lane, packed<4>", four, by_key<policy<reduce::per_lane, warpagg::commit::packed<4>>>{});
    }
    of.clear = [sums] { check(cudaMemset(sums->data(), 0, sums->size() * sizeof(float))); };
    of.result = [sums] { return sums->to_host(); };
    return of;
}

}  // namespace

std::vector<kernel_maker> scatter_cases() {
    std::vector<kernel_maker> all;
    constexpr struct {
        keys how;
        const char* name;
    } inputs[] = {{keys::uniform, "uniform keys"}, {keys::zipf, "Zipf keys"}, {keys::sorted, "sorted keys"}};
    for (const auto& in : inputs) {
        all.push_back([=] { return with_rows_of<1>(in.how, in.name); });
        all.push_back([=] { return with_rows_of<4>(in.how, in.name); });
        all.push_back([=] { return with_rows_of<64>(in.how, in.name); });
    }
    return all;
}
