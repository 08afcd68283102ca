// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The operations on a GPU. They only launch kernels, and return the first error of a launch. An
/// index outside the table stops the kernel by a device-side assertion.

#include <cuda_runtime_api.h>

#include "rows.hpp"

namespace warpagg::bindings::cuda_device {

/// Adds each row to its record, for float, double, int32 and int64. Integer sums do not depend on
/// the order.
template <class T>
cudaError_t add_rows(const rows_of<T>& rows, cudaStream_t stream);

/// Adds each row to its record, with fixed-point sums, for float and double: the same bits for any
/// order, and as on the CPU.
/// @param scratch  `fixed_point_words` zeros
template <class T>
cudaError_t add_rows_in_fixed_point(const rows_of<T>& rows, std::int64_t* scratch, cudaStream_t stream);

/// Returns the size of the scratch memory for fixed-point sums, in words of 64 bits.
template <class T>
std::int64_t fixed_point_words(const rows_of<T>& rows) {
    return static_cast<std::int64_t>(sizeof(T) / 4) * rows.records * rows.width + 1;
}

/// Replaces each value of a record by the largest, or the smallest, of its rows and itself.
template <class T>
cudaError_t extreme_rows(const rows_of<T>& rows, bool smallest, cudaStream_t stream);

}  // namespace warpagg::bindings::cuda_device
