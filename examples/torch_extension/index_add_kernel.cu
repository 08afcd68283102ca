// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <warpagg/atomic.hpp>

namespace {

/// A thread adds 4 neighboring floats of a row. Neighboring threads have neighboring parts of a row, and
/// then those of the next row: narrow rows meet in a warp, and those with the same index are summed first.
__global__ void index_add(float* table, const std::int64_t* index, const float4* rows, std::int64_t n,
                          unsigned parts) {
    const warpagg::cuda_warp w;
    const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    const bool active = i < n * parts;  // the lanes past the end take part with nothing to add
    unsigned part = 0;
    float4 row{};
    if (active) {
        part = static_cast<unsigned>(index[i / parts] * parts + i % parts);
        row = rows[i];
    }
    const float values[4] = {row.x, row.y, row.z, row.w};
    warpagg::warp_match_reduce_atomic(w, table, part, values, active);
}

}  // namespace

/// table[index[i]] += rows[i] for i in [0, n), rows of `width` floats, a multiple of 4; fewer than 2^32 parts
/// of 4 floats in `table`.
cudaError_t launch_index_add(float* table, const std::int64_t* index, const float* rows, std::int64_t n,
                             std::int64_t width, cudaStream_t stream) {
    constexpr unsigned block = 256;
    const std::int64_t parts = width / 4;
    const auto blocks = static_cast<unsigned>((n * parts + block - 1) / block);
    if (blocks > 0)
        index_add<<<blocks, block, 0, stream>>>(table, index, reinterpret_cast<const float4*>(rows), n,
                                                static_cast<unsigned>(parts));
    return cudaGetLastError();
}
