// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// The backward pass of a multiresolution hash grid, as in "Instant Neural Graphics Primitives with a
// Multiresolution Hash Encoding" (Müller et al. 2022): a thread per point, a row of blocks per level.

#include <cuda_runtime.h>

/// Returns the entry of a grid point: its place in a dense grid if the table is large enough, and its hash
/// otherwise.
__device__ __forceinline__ unsigned grid_entry(uint3 point, unsigned resolution, unsigned entries) {
    const unsigned side = resolution + 1;
    const unsigned place = side * side * side <= entries
                               ? point.x + side * (point.y + side * point.z)
                               : point.x ^ (point.y * 2654435761u) ^ (point.z * 805459861u);
    return place % entries;
}

/// Adds the gradients of `n` points in [0, 1)^3 to the table of each level, which has `entries` features.
/// Level l has `resolutions[l]` cells per axis.
__global__ void hash_grid_backward(const float3* __restrict__ points, unsigned n,
                                   const unsigned* __restrict__ resolutions, unsigned entries,
                                   const float2* __restrict__ dL_dfeatures, float2* __restrict__ dL_dtables) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const unsigned level = blockIdx.y;
    if (i >= n) return;

    const unsigned resolution = __ldg(&resolutions[level]);
    const float scale = static_cast<float>(resolution);
    const float3 point = points[i];
    const float3 scaled = make_float3(scale * point.x, scale * point.y, scale * point.z);
    const float3 cell = make_float3(floorf(scaled.x), floorf(scaled.y), floorf(scaled.z));
    const float3 part = make_float3(scaled.x - cell.x, scaled.y - cell.y, scaled.z - cell.z);
    const float2 dL_dfeature = dL_dfeatures[level * n + i];
    float2* const table = dL_dtables + level * entries;

    for (unsigned corner = 0; corner < 8; ++corner) {
        const uint3 upper = make_uint3(corner & 1u, (corner >> 1) & 1u, corner >> 2);
        const float weight = (upper.x != 0 ? part.x : 1.0f - part.x) *
                             (upper.y != 0 ? part.y : 1.0f - part.y) *
                             (upper.z != 0 ? part.z : 1.0f - part.z);
        const uint3 at =
            make_uint3(static_cast<unsigned>(cell.x) + upper.x, static_cast<unsigned>(cell.y) + upper.y,
                       static_cast<unsigned>(cell.z) + upper.z);
        const unsigned entry = grid_entry(at, resolution, entries);
        atomicAdd(&table[entry].x, weight * dL_dfeature.x);
        atomicAdd(&table[entry].y, weight * dL_dfeature.y);
    }
}
