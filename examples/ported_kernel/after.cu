// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cuda_runtime.h>

#include <warpagg/atomic.hpp>

/// Adds each pixel's gradients of the lamps that light it. A lamp lights pixels within its radius. The
/// number of threads per block is a multiple of 32.
__global__ void aggregated_lamp_gradients(const float2* centers, const float* radii, const float* powers,
                                          const float3* colors, int lamps, const float3* dL_dpixels,
                                          int width, int height, float* dL_dcolors, float2* dL_dcenters,
                                          float* dL_dradii, float* dL_dpowers) {
    const warpagg::cuda_warp w;
    const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    const bool inside = x < width && y < height;
    const float3 dL = inside ? dL_dpixels[y * width + x] : make_float3(0, 0, 0);

    for (int i = 0; i < lamps; ++i) {
        float values[7];
        const auto compute = [&]() -> bool {
            if (!inside) return false;
            const float dx = x - centers[i].x, dy = y - centers[i].y, r = radii[i];
            const float distance = (dx * dx + dy * dy) / (r * r);
            if (distance >= 1.0f) return false;  // the lamp does not reach this pixel

            const float falloff = 1.0f - distance, light = powers[i] * falloff * falloff;
            if (light < 1.0f / 255.0f) return false;  // too dark to be seen

            const float3 color = colors[i];
            const float dL_dlight = dL.x * color.x + dL.y * color.y + dL.z * color.z;
            const float slope = 4.0f * powers[i] * falloff / (r * r) * dL_dlight;
            values[0] = light * dL.x;
            values[1] = light * dL.y;
            values[2] = light * dL.z;
            values[3] = slope * dx;
            values[4] = slope * dy;
            values[5] = slope * distance * r;
            values[6] = falloff * falloff * dL_dlight;
            return true;
        };
        const bool active = compute();

        using warpagg::at;
        const auto gradients = warpagg::fields(at<3>(&dL_dcolors[3 * i]), at<2>(&dL_dcenters[i].x),
                                               at<1>(&dL_dradii[i]), at<1>(&dL_dpowers[i]));
        warpagg::warp_reduce_atomic(w, gradients, values, active);
    }
}
