// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// The backward pass of the splatting rasterizers: a thread per pixel walks the Gaussians of its tile
/// from back to front. Source: Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field
/// Rendering" (2023), section 6 and appendix C.

#include <warpagg/atomic.hpp>

namespace {

constexpr unsigned tile = 16, threads = tile * tile;
constexpr float near_zero_alpha = 1.0f / 255.0f, largest_alpha = 0.99f, opaque_transmittance = 1e-4f;

/// The sorted Gaussians of a frame and what the forward pass leaves for the backward pass.
struct frame {
    unsigned width, height, tiles_x;
    const float2* mean;
    const float4* conic_opacity;
    const float* color;  ///< [Gaussian][channel]
    const unsigned* list;
    const uint2* range;  ///< of a tile in the list
    float* transmittance;
    unsigned* last;           ///< number of listed Gaussians up to the last one that a pixel shows
    const float* pixel_grad;  ///< [channel][pixel]
};

__device__ float alpha_of(float4 conic_opacity, float2 d) {
    const float power =
        -0.5f * (conic_opacity.x * d.x * d.x + conic_opacity.z * d.y * d.y) - conic_opacity.y * d.x * d.y;
    return power > 0 ? 0.0f : fminf(largest_alpha, conic_opacity.w * __expf(power));
}

__global__ void __launch_bounds__(threads) forward(frame f) {
    const unsigned x = blockIdx.x * tile + threadIdx.x, y = blockIdx.y * tile + threadIdx.y;
    if (x >= f.width || y >= f.height) return;
    const uint2 range = f.range[blockIdx.y * f.tiles_x + blockIdx.x];
    float transmittance = 1;
    unsigned last = 0;
    for (unsigned k = range.x; k < range.y; ++k) {
        const unsigned id = f.list[k];
        const float2 m = f.mean[id];
        const float alpha =
            alpha_of(f.conic_opacity[id], {m.x - static_cast<float>(x), m.y - static_cast<float>(y)});
        if (alpha < near_zero_alpha) continue;
        if (transmittance * (1 - alpha) < opaque_transmittance) break;
        transmittance *= 1 - alpha;
        last = k - range.x + 1;
    }
    f.transmittance[y * f.width + x] = transmittance;
    f.last[y * f.width + x] = last;
}

/// Counts warp steps of the backward pass and those without an active lane.
struct count_steps {
    unsigned long long* steps;  ///< all, and idle
    template <int N>
    __device__ void operator()(warpagg::cuda_warp w, unsigned, const float (&)[N], bool active) const {
        const bool idle = warpagg::skip_if_warp_idle(w, active);
        if (w.lane() == 0) {
            atomicAdd(steps, 1ull);
            if (idle) atomicAdd(steps + 1, 1ull);
        }
    }
};

/// Adds to one record of N floats per Gaussian, aligned to 16 bytes.
template <class Policy, int N>
struct to_record {
    float* grad;
    __device__ void operator()(warpagg::cuda_warp w, unsigned id, const float (&g)[N], bool active) const {
        warpagg::warp_reduce_atomic(w, grad + std::size_t{id} * ((N + 3) / 4 * 4), g, active, Policy{});
    }
};

/// Adds to the arrays of the original: positions, conics, opacities and colors.
template <int Channels>
struct gradient_arrays {
    float3* mean;
    float4* conic;
    float* opacity;
    float* color;
    __device__ auto fields(unsigned id) const {
        using warpagg::at;
        return warpagg::fields(at<2>(&mean[id].x), at<3>(&conic[id].x), at<1>(opacity + id),
                               at<Channels>(color + std::size_t{id} * Channels));
    }
};
template <class Policy, int N>
struct to_arrays {
    gradient_arrays<N - 6> grad;
    __device__ void operator()(warpagg::cuda_warp w, unsigned id, const float (&g)[N], bool active) const {
        warpagg::warp_reduce_atomic(w, grad.fields(id), g, active, Policy{});
    }
};

/// One atomicAdd per pixel and component, as in the original.
template <int N>
struct plain_atomics {
    gradient_arrays<N - 6> grad;
    __device__ void operator()(warpagg::cuda_warp, unsigned id, const float (&g)[N], bool active) const {
        if (!active) return;
        atomicAdd(&grad.mean[id].x, g[0]);
        atomicAdd(&grad.mean[id].y, g[1]);
        atomicAdd(&grad.conic[id].x, g[2]);
        atomicAdd(&grad.conic[id].y, g[3]);
        atomicAdd(&grad.conic[id].z, g[4]);
        atomicAdd(grad.opacity + id, g[5]);
        for (int c = 0; c < N - 6; ++c) atomicAdd(grad.color + std::size_t{id} * (N - 6) + c, g[6 + c]);
    }
};

template <int Channels, class Add>
__global__ void __launch_bounds__(threads) backward(frame f, Add add) {
    const warpagg::cuda_warp w;
    __shared__ unsigned id_of[threads];
    __shared__ float2 mean_of[threads];
    __shared__ float4 conic_opacity_of[threads];
    __shared__ float color_of[threads * Channels];

    const unsigned x = blockIdx.x * tile + threadIdx.x, y = blockIdx.y * tile + threadIdx.y;
    const unsigned rank = threadIdx.y * tile + threadIdx.x, pixel = y * f.width + x;
    const bool inside = x < f.width && y < f.height;
    const uint2 range = f.range[blockIdx.y * f.tiles_x + blockIdx.x];
    const unsigned size = range.y - range.x;
    const unsigned last = inside ? f.last[pixel] : 0;
    float transmittance = inside ? f.transmittance[pixel] : 0;
    float pixel_grad[Channels], behind[Channels] = {};  // color of the Gaussians behind, premultiplied
    for (int c = 0; c < Channels; ++c)
        pixel_grad[c] = inside ? f.pixel_grad[std::size_t(c) * f.width * f.height + pixel] : 0.0f;

    for (unsigned first = 0; first < size; first += threads) {
        __syncthreads();
        if (first + rank < size) {
            const unsigned id = f.list[range.y - 1 - first - rank];
            id_of[rank] = id;
            mean_of[rank] = f.mean[id];
            conic_opacity_of[rank] = f.conic_opacity[id];
            for (int c = 0; c < Channels; ++c)
                color_of[c * threads + rank] = f.color[std::size_t{id} * Channels + c];
        }
        __syncthreads();
        const unsigned batch = min(threads, size - first);
        for (unsigned k = 0; k < batch; ++k) {
            const float2 d{mean_of[k].x - static_cast<float>(x), mean_of[k].y - static_cast<float>(y)};
            const float4 conic_opacity = conic_opacity_of[k];
            const float alpha = alpha_of(conic_opacity, d);
            const bool active = size - first - k <= last && alpha >= near_zero_alpha;
            float g[6 + Channels];
            if (active) {
                const float rest = 1 / (1 - alpha);
                transmittance *= rest;
                const float weight = alpha * transmittance;
                float alpha_grad = 0;
#pragma unroll
                for (int c = 0; c < Channels; ++c) {
                    const float color = color_of[c * threads + k];
                    alpha_grad += (color * transmittance - behind[c] * rest) * pixel_grad[c];
                    behind[c] += color * weight;
                    g[6 + c] = weight * pixel_grad[c];
                }
                const float gauss = alpha / conic_opacity.w;
                const float power_grad = gauss * conic_opacity.w * alpha_grad;
                g[0] = -power_grad * (conic_opacity.x * d.x + conic_opacity.y * d.y);
                g[1] = -power_grad * (conic_opacity.z * d.y + conic_opacity.y * d.x);
                g[2] = -0.5f * power_grad * d.x * d.x;
                g[3] = -power_grad * d.x * d.y;
                g[4] = -0.5f * power_grad * d.y * d.y;
                g[5] = gauss * alpha_grad;
            }
            add(w, id_of[k], g, active);
        }
    }
}

}  // namespace
