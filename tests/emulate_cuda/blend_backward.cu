// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// The backward pass of alpha blending, as in "3D Gaussian Splatting for Real-Time Radiance Field Rendering"
// (Kerbl et al. 2023): a block per tile of 16x16 pixels, a thread per pixel, back to front.

#include <cuda_runtime.h>

constexpr int tile_size = 16, batch_size = tile_size * tile_size;

/// The Gaussians of a tile are list[ranges[tile].x] to list[ranges[tile].y - 1], front to back. A conic has
/// the entries xx, xy and yy of the inverse covariance, and the opacity. `last` has the number of Gaussians
/// of the list up to the last one that a pixel shows.
__global__ void __launch_bounds__(batch_size)
    blend_backward(const uint2* __restrict__ ranges, const unsigned* __restrict__ list, int width, int height,
                   const float2* __restrict__ means, const float4* __restrict__ conics,
                   const float3* __restrict__ colors, float3 background,
                   const float* __restrict__ transmittances, const int* __restrict__ last,
                   const float3* __restrict__ dL_dpixels, float* __restrict__ dL_dcolors,
                   float* __restrict__ dL_dmeans, float* __restrict__ dL_dconics,
                   float* __restrict__ dL_dopacities) {
    __shared__ unsigned batch_ids[batch_size];
    __shared__ float2 batch_means[batch_size];
    __shared__ float4 batch_conics[batch_size];
    __shared__ float3 batch_colors[batch_size];

    const int x = static_cast<int>(blockIdx.x * tile_size + threadIdx.x);
    const int y = static_cast<int>(blockIdx.y * tile_size + threadIdx.y);
    const int rank = static_cast<int>(threadIdx.y * tile_size + threadIdx.x);
    const bool inside = x < width && y < height;
    const int pixel = y * width + x;
    const uint2 range = ranges[blockIdx.y * gridDim.x + blockIdx.x];
    const int in_tile = static_cast<int>(range.y - range.x);

    const float final_T = inside ? transmittances[pixel] : 0.0f;
    const int shown = inside ? last[pixel] : 0;
    const float3 dL_dpixel = inside ? dL_dpixels[pixel] : make_float3(0.0f, 0.0f, 0.0f);
    const float dL_dbackground =
        background.x * dL_dpixel.x + background.y * dL_dpixel.y + background.z * dL_dpixel.z;
    float T = final_T;
    float3 behind = make_float3(0.0f, 0.0f, 0.0f);  // the blended color behind the current Gaussian

    for (int end = in_tile; end > 0; end -= batch_size) {
        __syncthreads();  // the previous batch is no longer needed
        const int mine = end - 1 - rank;
        if (mine >= 0) {
            const unsigned id = list[range.x + static_cast<unsigned>(mine)];
            batch_ids[rank] = id;
            batch_means[rank] = means[id];
            batch_conics[rank] = conics[id];
            batch_colors[rank] = colors[id];
        }
        __syncthreads();  // the batch is complete

        const int count = min(batch_size, end);
        for (int j = 0; inside && j < count; ++j) {
            if (end - 1 - j >= shown) continue;

            const float dx = batch_means[j].x - static_cast<float>(x);
            const float dy = batch_means[j].y - static_cast<float>(y);
            const float4 conic = batch_conics[j];
            const float power = -0.5f * (conic.x * dx * dx + conic.z * dy * dy) - conic.y * dx * dy;
            if (power > 0.0f) continue;
            const float falloff = expf(power);
            const float alpha = fminf(0.99f, conic.w * falloff);
            if (alpha < 1.0f / 255.0f) continue;

            T = T / (1.0f - alpha);
            const float3 color = batch_colors[j];
            float dL_dalpha = T * ((color.x - behind.x) * dL_dpixel.x + (color.y - behind.y) * dL_dpixel.y +
                                   (color.z - behind.z) * dL_dpixel.z);
            dL_dalpha -= final_T / (1.0f - alpha) * dL_dbackground;
            behind.x += alpha * (color.x - behind.x);
            behind.y += alpha * (color.y - behind.y);
            behind.z += alpha * (color.z - behind.z);

            const float dL_dpower = dL_dalpha * conic.w * falloff;
            const unsigned id = batch_ids[j];
            atomicAdd(&dL_dcolors[3 * id + 0], alpha * T * dL_dpixel.x);
            atomicAdd(&dL_dcolors[3 * id + 1], alpha * T * dL_dpixel.y);
            atomicAdd(&dL_dcolors[3 * id + 2], alpha * T * dL_dpixel.z);
            atomicAdd(&dL_dmeans[2 * id + 0], -dL_dpower * (conic.x * dx + conic.y * dy));
            atomicAdd(&dL_dmeans[2 * id + 1], -dL_dpower * (conic.z * dy + conic.y * dx));
            atomicAdd(&dL_dconics[3 * id + 0], -0.5f * dL_dpower * dx * dx);
            atomicAdd(&dL_dconics[3 * id + 1], -dL_dpower * dx * dy);
            atomicAdd(&dL_dconics[3 * id + 2], -0.5f * dL_dpower * dy * dy);
            atomicAdd(&dL_dopacities[id], dL_dalpha * falloff);
        }
    }
}
