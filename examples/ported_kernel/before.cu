// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cuda_runtime.h>

/// Adds each pixel's gradients of the lamps that light it. A lamp lights pixels within its radius.
__global__ void lamp_gradients(const float2* centers, const float* radii, const float* powers,
                               const float3* colors, int lamps, const float3* dL_dpixels, int width,
                               int height, float* dL_dcolors, float2* dL_dcenters, float* dL_dradii,
                               float* dL_dpowers) {
    const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    if (x >= width || y >= height) return;
    const float3 dL = dL_dpixels[y * width + x];

    for (int i = 0; i < lamps; ++i) {
        const float dx = x - centers[i].x, dy = y - centers[i].y, r = radii[i];
        const float distance = (dx * dx + dy * dy) / (r * r);
        if (distance >= 1.0f) continue;  // the lamp does not reach this pixel

        const float falloff = 1.0f - distance, light = powers[i] * falloff * falloff;
        if (light < 1.0f / 255.0f) continue;  // too dark to be seen

        const float3 color = colors[i];
        const float dL_dlight = dL.x * color.x + dL.y * color.y + dL.z * color.z;
        const float slope = 4.0f * powers[i] * falloff / (r * r) * dL_dlight;
        atomicAdd(&dL_dcolors[3 * i + 0], light * dL.x);
        atomicAdd(&dL_dcolors[3 * i + 1], light * dL.y);
        atomicAdd(&dL_dcolors[3 * i + 2], light * dL.z);
        atomicAdd(&dL_dcenters[i].x, slope * dx);
        atomicAdd(&dL_dcenters[i].y, slope * dy);
        atomicAdd(&dL_dradii[i], slope * distance * r);
        atomicAdd(&dL_dpowers[i], falloff * falloff * dL_dlight);
    }
}
