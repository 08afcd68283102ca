// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// A reduction with cooperative groups: lanes of a warp by cg::reduce, warps of a block through shared
// memory, blocks by atomics.

#include <cooperative_groups.h>
#include <cooperative_groups/reduce.h>

namespace cg = cooperative_groups;

/// Adds the sum of the positive values to `*sum`, and their number to `*count`.
__global__ void sum_positive(const float* __restrict__ values, unsigned n, float* sum, unsigned* count) {
    __shared__ float warp_sums[32];
    const cg::thread_block block = cg::this_thread_block();
    const cg::thread_block_tile<32> warp = cg::tiled_partition<32>(block);
    const unsigned lane = warp.thread_rank(), warps = block.size() / 32;

    float mine = 0.0f;
    unsigned found = 0;
    for (unsigned first = blockIdx.x * block.size(); first < n; first += gridDim.x * block.size()) {
        const unsigned i = first + block.thread_rank();
        const float v = i < n ? values[i] : 0.0f;
        const unsigned positive = warp.ballot(v > 0.0f);
        found += static_cast<unsigned>(__popc(positive));
        mine += fmaxf(v, 0.0f);
    }
    const float warp_sum = cg::reduce(warp, mine, cg::plus<float>());
    if (lane == 0) {
        warp_sums[block.thread_rank() / 32] = warp_sum;
        if (found > 0) atomicAdd(count, found);
    }
    block.sync();

    if (block.thread_rank() < 32) {
        float total = lane < warps ? warp_sums[lane] : 0.0f;
        for (unsigned distance = 16; distance > 0; distance /= 2) total += warp.shfl_down(total, distance);
        if (lane == 0) atomicAdd(sum, total);
    }
}
