// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The functions of the Python module `warpagg.torch._extension`. Its callers in rows.py check what
/// users pass; the checks here keep memory safe.

#include <ATen/ATen.h>
#include <torch/csrc/utils/pybind.h>

#include "cpu.hpp"
#if defined(WARPAGG_TORCH_CUDA)
#include <c10/cuda/CUDAException.h>
#include <c10/cuda/CUDAGuard.h>
#include <c10/cuda/CUDAStream.h>

#include "cuda.hpp"
#endif

namespace {

using at::Tensor;
using warpagg::bindings::rows_of;

void check(const Tensor& table, const Tensor& index, const Tensor& rows) {
    TORCH_CHECK(table.is_contiguous() && index.is_contiguous() && rows.is_contiguous(),
                "tensors must be contiguous");
    TORCH_CHECK(table.device() == rows.device() && table.device() == index.device(),
                "tensors must be on one device");
    TORCH_CHECK(table.scalar_type() == rows.scalar_type() && index.scalar_type() == at::kLong,
                "the table and the rows must have one dtype, and the index int64");
    TORCH_CHECK(table.dim() == 2 && rows.dim() == 2 && index.dim() == 1 && table.size(1) == rows.size(1) &&
                    index.size(0) == rows.size(0),
                "shapes must be [records, width], [n] and [n, width]");
    // Keys and widths have 32 bits on a GPU.
    TORCH_CHECK(table.size(0) < (std::int64_t{1} << 32) && rows.size(0) <= (std::int64_t{1} << 32) &&
                    table.size(1) < (std::int64_t{1} << 31),
                "there must be fewer than 2^32 records and rows, and fewer than 2^31 values in a row");
#if !defined(WARPAGG_TORCH_CUDA)
    TORCH_CHECK(table.is_cpu(),
                "warpagg.torch was built without CUDA: build it with nvcc and a PyTorch that "
                "has CUDA");
#endif
}

/// Calls f with a value of the tensor's type: one of the four, or of the first two.
/// @{
template <class F>
void with_float_type(const Tensor& t, const F& f) {
    if (t.scalar_type() == at::kFloat)
        f(float{});
    else if (t.scalar_type() == at::kDouble)
        f(double{});
    else
        TORCH_CHECK(false, "the dtype is not supported");
}
template <class F>
void with_type(const Tensor& t, const F& f) {
    if (t.scalar_type() == at::kInt)
        f(std::int32_t{});
    else if (t.scalar_type() == at::kLong)
        f(std::int64_t{});
    else
        with_float_type(t, f);
}
/// @}

bool is_aligned(const void* address) { return reinterpret_cast<std::uintptr_t>(address) % 16 == 0; }

/// Calls f(rows_of<T>) for the type of the tensors.
template <class T, class F>
void with_rows(const Tensor& table, const Tensor& index, const Tensor& rows, const F& f) {
    const Tensor aligned = is_aligned(rows.data_ptr()) ? rows : rows.clone();
    f(rows_of<T>{aligned.data_ptr<T>(), index.data_ptr<std::int64_t>(), rows.size(0), rows.size(1),
                 table.size(0), table.data_ptr<T>()});
}

#if defined(WARPAGG_TORCH_CUDA)
Tensor scratch(const Tensor& table, std::int64_t words) {
    return at::zeros({words}, table.options().dtype(at::kLong));
}
#endif

/// table[index[i]] += rows[i]. With `fixed_point`, sums of floats have the same bits for any order.
void add_rows_(const Tensor& table, const Tensor& index, const Tensor& rows, bool fixed_point) {
    check(table, index, rows);
    if (rows.numel() == 0) return;
#if defined(WARPAGG_TORCH_CUDA)
    if (table.is_cuda()) {
        const c10::cuda::CUDAGuard guard(table.device());
        const cudaStream_t stream = c10::cuda::getCurrentCUDAStream();
        namespace cuda = warpagg::bindings::cuda_device;
        if (fixed_point)
            with_float_type(table, [&](auto zero) {
                with_rows<decltype(zero)>(table, index, rows, [&](const auto& problem) {
                    const Tensor sums = scratch(table, cuda::fixed_point_words(problem));
                    C10_CUDA_CHECK(
                        cuda::add_rows_in_fixed_point(problem, sums.data_ptr<std::int64_t>(), stream));
                });
            });
        else
            with_type(table, [&](auto zero) {
                with_rows<decltype(zero)>(table, index, rows, [&](const auto& problem) {
                    C10_CUDA_CHECK(cuda::add_rows(problem, stream));
                });
            });
        return;
    }
#endif
    namespace cpu = warpagg::bindings::cpu;
    if (fixed_point)
        with_float_type(table, [&](auto zero) {
            with_rows<decltype(zero)>(table, index, rows,
                                      [](const auto& problem) { cpu::add_rows_in_fixed_point(problem); });
        });
    else
        with_type(table, [&](auto zero) {
            with_rows<decltype(zero)>(table, index, rows,
                                      [](const auto& problem) { cpu::add_rows(problem); });
        });
}

/// table[index[i]] = max(table[index[i]], rows[i]), or min. NaN is the result if a value is NaN.
void extreme_rows_(const Tensor& table, const Tensor& index, const Tensor& rows, bool smallest) {
    check(table, index, rows);
    if (rows.numel() == 0) return;
    with_type(table, [&](auto zero) {
        with_rows<decltype(zero)>(table, index, rows, [&](const auto& problem) {
#if defined(WARPAGG_TORCH_CUDA)
            if (table.is_cuda()) {
                const c10::cuda::CUDAGuard guard(table.device());
                C10_CUDA_CHECK(warpagg::bindings::cuda_device::extreme_rows(
                    problem, smallest, c10::cuda::getCurrentCUDAStream()));
                return;
            }
#endif
            warpagg::bindings::cpu::extreme_rows(problem, smallest);
        });
    });
}

}  // namespace

PYBIND11_MODULE(TORCH_EXTENSION_NAME, m) {
    m.def("add_rows_", &add_rows_);
    m.def("extreme_rows_", &extreme_rows_);
#if defined(WARPAGG_TORCH_CUDA)
    m.attr("has_cuda") = true;
#else
    m.attr("has_cuda") = false;
#endif
}
