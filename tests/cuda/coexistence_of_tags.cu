// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Compiles if `using namespace warpagg::tags` leaves names of the CUDA toolkit, of the standard library and
// of PyTorch usable, also without qualification.
#include <cooperative_groups.h>
#include <cooperative_groups/reduce.h>
#include <thrust/device_vector.h>
#include <thrust/reduce.h>

#include <algorithm>
#include <cub/cub.cuh>
#include <cuda/atomic>
#include <warpagg/atomic.hpp>
#include <warpagg/reduce/cooperative.hpp>
#include <warpagg/reduce/cub.hpp>

using namespace cooperative_groups;
using namespace std;
using namespace warpagg::tags;

__global__ void add(float* totals) {
    const auto group = tiled_partition<32>(this_thread_block());
    const float largest =
        cooperative_groups::reduce(group, totals[threadIdx.x], cooperative_groups::greater<float>());
    const float two[2] = {::max(largest, 0.0f), ::min(largest, 0.0f)};
    const warpagg::cuda_warp w;
    warpagg::warp_reduce_atomic(w, totals, two, threadIdx.x % 2 == 0, policy{shfl_down, scalar});
    warpagg::warp_reduce_atomic(w, totals, two, threadIdx.x % 2 == 0, policy{warpagg::tags::cub});
    warpagg::warp_reduce_atomic(w, totals, two, threadIdx.x % 2 == 0, policy{cooperative});
    cuda::atomic_ref<float, cuda::thread_scope_system>(totals[2]).store(largest, cuda::memory_order_relaxed);
}

namespace at {

// Names of PyTorch that hide tags: a using-declaration in the kernel names the tag.
int scatter(int);
namespace native {

__global__ void add(float* totals) {
    using warpagg::tags::scatter;
    const float two[2] = {1, 2};
    warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, totals, two, true, policy{scatter, skip});
}

}  // namespace native
}  // namespace at

float sum(const thrust::device_vector<float>& values) {
    using block_reduce = cub::BlockReduce<float, 128>;
    static_assert(sizeof(block_reduce::TempStorage) > 0);
    return max(thrust::reduce(values.begin(), values.end(), 0.0f), 0.0f);
}
