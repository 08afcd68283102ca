// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The backward pass of attribute interpolation on a mesh: a thread per pixel adds the gradient of each
/// attribute to the 3 vertices of its triangle. Source: Laine et al., "Modular Primitives for
/// High-Performance Differentiable Rendering" (2020), section 3.4.

#include <memory>
#include <random>
#include <warpagg/atomic.hpp>

#include "kernel.hpp"

namespace {

namespace reduce = warpagg::reduce;
using warpagg::policy;

constexpr unsigned size = 1024;

/// A square of size² pixels under a mesh of right triangles with legs of `edge` pixels.
struct mesh {
    device_array<int3> triangle;
    device_array<unsigned> triangle_of_pixel;  ///< 0: none, otherwise the triangle's index + 1
    device_array<float2> weights;              ///< of the first two vertices
    unsigned vertices;
};

std::shared_ptr<const mesh> make_mesh(unsigned edge) {
    const unsigned cells = size / edge;
    const auto vertex = [cells](unsigned x, unsigned y) { return static_cast<int>(y * (cells + 1) + x); };
    std::vector<int3> triangle;
    for (unsigned y = 0; y < cells; ++y)
        for (unsigned x = 0; x < cells; ++x) {
            triangle.push_back({vertex(x, y), vertex(x + 1, y), vertex(x, y + 1)});
            triangle.push_back({vertex(x + 1, y + 1), vertex(x, y + 1), vertex(x + 1, y)});
        }
    std::vector<unsigned> of_pixel;
    std::vector<float2> weights;
    for (unsigned y = 0; y < size; ++y)
        for (unsigned x = 0; x < size; ++x) {
            const unsigned cx = x / edge, cy = y / edge;
            float u = (static_cast<float>(x % edge) + 0.5f) / static_cast<float>(edge);
            float v = (static_cast<float>(y % edge) + 0.5f) / static_cast<float>(edge);
            const bool upper = u + v > 1;
            if (upper) u = 1 - u, v = 1 - v;
            const int dx = static_cast<int>(x) - size / 2, dy = static_cast<int>(y) - size / 2;
            const bool covered = dx * dx + dy * dy < static_cast<int>(size * size / 5);
            of_pixel.push_back(covered ? 2 * (cy * cells + cx) + upper + 1 : 0);
            weights.push_back({1 - u - v, u});
        }
    return std::shared_ptr<const mesh>(new mesh{device_array(triangle), device_array(of_pixel),
                                                device_array(weights), (cells + 1) * (cells + 1)});
}

template <int Attributes, class Add>
__global__ void __launch_bounds__(256)
    backward(const int3* triangle, const unsigned* triangle_of_pixel, const float2* weights,
             const float* pixel_grad, float* grad, Add add) {
    const warpagg::cuda_warp w;
    const unsigned x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    const unsigned pixel = y * size + x, id = triangle_of_pixel[pixel];
    const bool active = id != 0;
    const int3 v = active ? triangle[id - 1] : int3{};
    const float2 b = weights[pixel];
    const float weight[3] = {b.x, b.y, 1 - b.x - b.y};
    const unsigned vertex[3] = {static_cast<unsigned>(v.x), static_cast<unsigned>(v.y),
                                static_cast<unsigned>(v.z)};
    float g[Attributes];
#pragma unroll
    for (int a = 0; a < Attributes; a += 4) {
        const float4 f = *reinterpret_cast<const float4*>(pixel_grad + std::size_t{pixel} * Attributes + a);
        g[a] = f.x, g[a + 1] = f.y, g[a + 2] = f.z, g[a + 3] = f.w;
    }
#pragma unroll
    for (int corner = 0; corner < 3; ++corner) {
        float values[Attributes];
        for (int a = 0; a < Attributes; ++a) values[a] = weight[corner] * g[a];
        add(w, grad, vertex[corner], values, active);
    }
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
/// A call for each attribute, as in a loop over attributes.
struct by_attribute {
    template <int N>
    __device__ void operator()(warpagg::cuda_warp w, float* base, unsigned key, const float (&v)[N],
                               bool active) const {
        for (int i = 0; i < N; ++i) {
            const float one[1] = {v[i]};
            warpagg::warp_match_reduce_atomic(
                w, [base, i](unsigned k, unsigned) { return base + std::size_t{k} * N + i; }, key, one,
                active);
        }
    }
};

/// As `by_attribute`, with keys that are compared once.
struct matched_once {
    template <int N>
    __device__ void operator()(warpagg::cuda_warp w, float* base, unsigned key, const float (&v)[N],
                               bool active) const {
        const auto peers = warpagg::match(w, key, active);
        for (int i = 0; i < N; ++i) {
            const float one[1] = {v[i]};
            peers.add([base, i](unsigned k, unsigned) { return base + std::size_t{k} * N + i; }, one);
        }
    }
};

template <int Attributes>
kernel_case with_attributes(unsigned edge) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> host(std::size_t{size} * size * Attributes);
    for (float& g : host) g = unit(random);
    const auto in = make_mesh(edge);
    const auto pixel_grad = std::make_shared<const device_array<float>>(host);
    const auto grad = std::make_shared<device_array<float>>(std::size_t{in->vertices} * Attributes);
    kernel_case of{"interpolation, N = " + std::to_string(Attributes),
                   "triangles of " + std::to_string(edge) + " pixels",
                   {},
                   {},
                   {}};
    const auto variant = [&]<class Add>(const char* name, Add add) {
        of.variants.push_back({name, [in, pixel_grad, grad, add] {
                                   backward<Attributes><<<dim3(size / 8, size / 32), dim3(8, 32)>>>(
                                       in->triangle.data(), in->triangle_of_pixel.data(), in->weights.data(),
                                       pixel_grad->data(), grad->data(), add);
                               }});
    };
    variant("plain atomics", plain_atomics{});
    variant("default", by_key<policy<>>{});
    variant("per_lane", by_key<policy<reduce::per_lane>>{});
    variant("default, a call per attribute", by_attribute{});
    variant("match once, a call per attribute", matched_once{});
    of.clear = [grad] { check(cudaMemset(grad->data(), 0, grad->size() * sizeof(float))); };
    of.result = [grad] { return grad->to_host(); };
    return of;
}

}  // namespace

std::vector<kernel_maker> interpolation_cases() {
    std::vector<kernel_maker> all;
    for (const unsigned edge : {2u, 8u, 64u}) {
        all.push_back([=] { return with_attributes<4>(edge); });
        all.push_back([=] { return with_attributes<16>(edge); });
    }
    return all;
}
