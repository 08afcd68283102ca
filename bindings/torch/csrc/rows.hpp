// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The arguments of the CPU and CUDA versions of the operations.

#include <cstdint>

namespace warpagg::bindings {

/// A table of `records` records and `n` rows, all of `width` values, and for each row the record
/// that it belongs to. `values` is aligned to 16 bytes.
template <class T>
struct rows_of {
    const T* values;
    const std::int64_t* index;
    std::int64_t n, width, records;
    T* table;
};

}  // namespace warpagg::bindings
