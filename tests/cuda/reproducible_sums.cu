// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

#include "../support/backends/cuda.hpp"
// The order matters: the sums take memory of the backend.
#include "reproducible_sums.hpp"

namespace {

template <class Kernel>
__global__ void each_warp(Kernel kernel) {
    const unsigned warps_per_block = blockDim.x / 32;
    kernel(warpagg::cuda_warp{}, std::size_t{blockIdx.x} * warps_per_block + threadIdx.x / 32,
           std::size_t{gridDim.x} * warps_per_block);
}

struct run_on_gpu {
    launch_shape shape;

    template <class Kernel>
    void operator()(const Kernel& kernel) const {
        each_warp<<<shape.blocks, shape.warps_per_block * 32>>>(kernel);
        check_cuda(cudaGetLastError(), "launch");
        check_cuda(cudaDeviceSynchronize(), "kernel");
    }
};

}  // namespace

std::vector<float> fixed_point_sums_on_gpu(const rows_to_add<float>& rows, launch_shape shape) {
    return fixed_point_sums(rows, run_on_gpu{shape});
}
std::vector<double> fixed_point_sums_on_gpu(const rows_to_add<double>& rows, launch_shape shape) {
    return fixed_point_sums(rows, run_on_gpu{shape});
}
std::vector<float> exact_sums_on_gpu(const rows_to_add<float>& rows, launch_shape shape) {
    return exact_sums(rows, run_on_gpu{shape});
}
