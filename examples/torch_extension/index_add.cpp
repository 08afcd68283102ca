// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <c10/cuda/CUDAException.h>
#include <c10/cuda/CUDAGuard.h>
#include <c10/cuda/CUDAStream.h>
#include <torch/extension.h>

cudaError_t launch_index_add(float* table, const std::int64_t* index, const float* rows, std::int64_t n,
                             std::int64_t width, cudaStream_t stream);

/// table[index[i]] += rows[i], as `table.index_add_(0, index, rows)`. As there, an index beyond the table is
/// the caller's fault; unlike there, nobody says so.
void index_add(torch::Tensor table, const torch::Tensor& index, const torch::Tensor& rows) {
    for (const torch::Tensor& t : {table, index, rows})
        TORCH_CHECK(t.device() == table.device() && t.is_cuda() && t.is_contiguous(),
                    "index_add_ takes contiguous tensors on one GPU");
    TORCH_CHECK(table.scalar_type() == torch::kFloat && rows.scalar_type() == torch::kFloat &&
                    index.scalar_type() == torch::kLong,
                "index_add_ takes float rows and int64 indices");
    TORCH_CHECK(table.dim() == 2 && rows.dim() == 2 && index.dim() == 1 && table.size(1) == rows.size(1) &&
                    index.size(0) == rows.size(0),
                "index_add_ takes a table [m, d], an index [n] and rows [n, d]");
    TORCH_CHECK(rows.size(1) % 4 == 0, "index_add_ takes rows of a multiple of 4 floats");
    const c10::cuda::CUDAGuard guard(table.device());
    C10_CUDA_CHECK(launch_index_add(table.data_ptr<float>(), index.data_ptr<std::int64_t>(),
                                    rows.data_ptr<float>(), rows.size(0), rows.size(1),
                                    c10::cuda::getCurrentCUDAStream()));
}

PYBIND11_MODULE(TORCH_EXTENSION_NAME, m) { m.def("index_add_", &index_add); }
