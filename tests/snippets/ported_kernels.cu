// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// The code of docs/explanation/when_not_to_use.md, docs/how-to/port_five_kernels.md and
// docs/tutorials/port_a_kernel.md.

#include <cuda_runtime.h>

#include <warpagg/atomic.hpp>
#if defined(__CUDACC__)
#include <cuda_fp16.h>
#endif

/// Adds each row of `values`, of 4 * parts floats, to the row of `sums` that `index` names.
__global__ void scatter_rows(const float4* values, const unsigned* index, unsigned rows, unsigned parts,
                             float* sums) {
    const warpagg::cuda_warp w;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const bool active = i < rows * parts;
    const float4 v = active ? values[i] : float4{};
    const unsigned key = active ? index[i / parts] * parts + i % parts : 0;
    warpagg::warp_match_reduce_atomic(w, sums, key, {v.x, v.y, v.z, v.w}, active);
}

/// Adds each value to the sum that `index`, which is sorted, names.
__global__ void sum_segments(const float* values, const long long* index, unsigned n, float* sums) {
    const warpagg::cuda_warp w;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const bool active = i < n;
    const long long key = active ? index[i] : 0;
    warpagg::warp_match_reduce_atomic(w, sums, key, {active ? values[i] : 0.0f}, active);
}

/// Adds this pixel's gradients of Gaussian `id`: color, position, conic and opacity.
__device__ void add_gaussian(float* dL_dcolors, float3* dL_dmean2D, float4* dL_dconic2D, float* dL_dopacity,
                             unsigned id, const float (&values)[9], bool active) {
    using warpagg::at;
    const auto gradients =
        warpagg::fields(at<3>(dL_dcolors + 3 * id), at<2>(&dL_dmean2D[id].x), at<2>(&dL_dconic2D[id].x),
                        at<1>(&dL_dconic2D[id].w), at<1>(dL_dopacity + id));
    warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, gradients, values, active);
}

/// Adds this pixel's gradients of Gaussian `id`: colors, conic, position and opacity. At least one lane
/// of the warp is valid.
template <int Channels>
__device__ void add_channels(float* v_colors, float3* v_conics, float2* v_means2d, float* v_opacities,
                             unsigned id, const float (&values)[Channels + 6], bool valid) {
    using warpagg::at;
    const auto gradients = warpagg::fields(at<Channels>(v_colors + Channels * id), at<3>(&v_conics[id].x),
                                           at<2>(&v_means2d[id].x), at<1>(v_opacities + id));
    warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, gradients, values, valid,
                                warpagg::policy{warpagg::assume_busy});
}

/// Adds this pixel's gradients of the attributes at the 3 vertices of its triangle.
template <int Attributes>
__device__ void add_to_vertices(float* gradients, const int (&vertex)[3], const float (&weight)[3],
                                const float (&dy)[Attributes], bool covered) {
    const warpagg::cuda_warp w;
    for (int corner = 0; corner < 3; ++corner) {
        float values[Attributes];
        for (int a = 0; a < Attributes; ++a) values[a] = weight[corner] * dy[a];
        warpagg::warp_match_reduce_atomic(w, gradients, vertex[corner], values, covered);
    }
}

/// Does the same for a number of attributes that is known at run time.
__device__ inline void add_to_vertices(float* gradients, const int (&vertex)[3], const float (&weight)[3],
                                       const float* dy, int attributes, bool covered) {
    const warpagg::cuda_warp w;
    for (int corner = 0; corner < 3; ++corner) {
        const auto peers = warpagg::match(w, vertex[corner], covered);
        for (int a = 0; a < attributes; ++a) {
            const float value[1] = {covered ? weight[corner] * dy[a] : 0.0f};
            peers.add([=](unsigned v, unsigned) { return gradients + v * attributes + a; }, value);
        }
    }
}

/// Each thread buys items in order until its money is spent. Counts how often each item is sold.
__global__ void sell(const float* prices, int items, const float* money, unsigned n, float* sold) {
    const warpagg::cuda_warp w;
    const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x;
    float rest = thread < n ? money[thread] : 0.0f;
    bool done = thread >= n;
    for (int i = 0; i < items; ++i) {
        if (warpagg::skip_if_warp_idle(w, !done)) break;  // all lanes are done
        const auto buy = [&]() -> bool {
            if (done) return false;
            if (prices[i] > rest) {  // was: if (prices[i] > rest) break;
                done = true;
                return false;
            }
            rest -= prices[i];
            return true;
        };
        const bool active = buy();
        warpagg::warp_reduce_atomic(w, sold + i, {1.0f}, active);
    }
}

/// Adds to the records of a vertex in three arrays.
__device__ inline void add_to_arrays(float* colors, float2* centers, float* radii, unsigned vertex,
                                     const float (&color)[3], const float (&center)[2], float radius,
                                     bool active) {
    const warpagg::cuda_warp w;
    const auto peers = warpagg::match(w, vertex, active);
    peers.add(colors, color);        // to colors[3 * vertex] and the next two
    peers.add(&centers->x, center);  // to centers[vertex]
    peers.add(radii, {radius});      // to radii[vertex]
}

#if defined(__CUDACC__)
/// Adds this point's gradient of one corner of its cell to the entry of a level.
__device__ void add_to_entry(__half2* level, unsigned entry, float weight, float2 gradient, bool active) {
    const __half2 values[1] = {__floats2half2_rn(weight * gradient.x, weight * gradient.y)};
    warpagg::warp_match_reduce_atomic(warpagg::cuda_warp{}, level, entry, values, active);
}
#endif
