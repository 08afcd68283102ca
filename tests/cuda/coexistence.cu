// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Compiles if `using namespace warpagg` leaves the names of the CUDA toolkit's libraries usable, whose
// namespaces are `cuda`, `cub`, `thrust` and `cooperative_groups`.
#include <cooperative_groups.h>
#include <cooperative_groups/reduce.h>
#include <thrust/device_vector.h>
#include <thrust/reduce.h>

#include <cub/cub.cuh>
#include <cuda/atomic>
#include <cuda/std/span>
#include <warpagg/atomic.hpp>
#include <warpagg/reduce/cooperative.hpp>
#include <warpagg/reduce/cub.hpp>
#include <warpagg/segmented_sum.hpp>

using namespace warpagg;

__global__ void count(unsigned* total) {
    cuda::atomic_ref<unsigned, cuda::thread_scope_device>(*total).fetch_add(1, cuda::memory_order_relaxed);
}
__global__ void add_span(cuda::std::span<const float> values, float* total) {
    const float value[1] = {values[threadIdx.x]};
    warp_reduce_atomic(cuda_warp{}, total, value, true);
}

__global__ void add_blocks(const float* values, float* totals) {
    using block_reduce = cub::BlockReduce<float, 128>;
    __shared__ block_reduce::TempStorage storage;
    const float sum = block_reduce(storage).Sum(values[threadIdx.x]);
    const auto group = cooperative_groups::tiled_partition<32>(cooperative_groups::this_thread_block());
    const float largest =
        cooperative_groups::reduce(group, values[threadIdx.x], cooperative_groups::greater<float>());
    const float two[2] = {sum, largest};
    const cuda_warp w;
    warp_reduce_atomic(w, totals, two, threadIdx.x % 2 == 0, policy{shfl_down, scalar});
    warp_reduce_atomic(w, totals, two, threadIdx.x % 2 == 0, policy{warpagg::cub});
    warp_reduce_atomic(w, totals, two, threadIdx.x % 2 == 0, policy{cooperative});
    warp_match_reduce_atomic(w, totals, threadIdx.x % 4, two, true);
}

float add(const thrust::device_vector<float>& values) {
    return thrust::reduce(values.begin(), values.end(), 0.0f, thrust::plus<float>());
}
