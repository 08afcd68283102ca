// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What the sums of rows by key have in common: inputs, and the kernel that adds each row on its own.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>
#include <warpagg/atomic.hpp>

#include "kernel.hpp"

namespace {

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

enum class keys { uniform, zipf, sorted };

constexpr struct {
    keys how;
    const char* name;
} key_distributions[] = {
    {keys::uniform, "uniform keys"}, {keys::zipf, "Zipf keys"}, {keys::sorted, "sorted keys"}};

inline std::vector<unsigned> draw_keys(keys how, unsigned rows, unsigned segments) {
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

/// The input and the result of a scatter of rows of `Width` floats, 16 rows per key in the mean.
template <int Width>
struct scatter_memory {
    static constexpr unsigned rows = (1u << 22) / (Width < 4 ? 1 : Width / 4), segments = rows / 16;

    device_array<unsigned> key;
    device_array<float> values;
    device_array<float> sums{std::size_t{segments} * Width};

    explicit scatter_memory(keys how) : key(draw_keys(how, rows, segments)), values(draw_values()) {}

    /// Returns a variant that adds `Each` values per thread.
    template <int Each, class Add>
    static variant variant_of(const char* name, const std::shared_ptr<scatter_memory>& of, Add add) {
        return {name, [of, add] {
                    constexpr unsigned all = rows * (Width / Each);
                    scatter<Width, Each><<<(all + threads - 1) / threads, threads>>>(
                        rows, of->key.data(), of->values.data(), of->sums.data(), add);
                }};
    }
    /// Returns a case without variants.
    static kernel_case case_of(const std::string& kernel, const char* input,
                               const std::shared_ptr<scatter_memory>& of) {
        return {kernel + ", rows of " + std::to_string(Width),
                input,
                {},
                [of] { check(cudaMemset(of->sums.data(), 0, of->sums.size() * sizeof(float))); },
                [of] { return of->sums.to_host(); }};
    }

  private:
    static std::vector<float> draw_values() {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> unit(0, 1);
        std::vector<float> host(std::size_t{rows} * Width);
        for (float& v : host) v = unit(random);
        return host;
    }
};

}  // namespace
