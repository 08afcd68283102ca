// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The operations on a CPU. Each thread owns some records and adds their rows in order, so results
/// do not depend on the number of threads. Rows whose index is outside the table are left out.

#include <ATen/Parallel.h>

#include <algorithm>
#include <vector>
#include <warpagg/fixed_point.hpp>

#include "rows.hpp"

namespace warpagg::bindings::cpu {

/// Calls f(row, record) for each row, in parallel for different records.
template <class T, class F>
void for_each_row(const rows_of<T>& rows, const F& f) {
    at::parallel_for(0, rows.records, 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = 0; row < rows.n; ++row)
            if (rows.index[row] >= begin && rows.index[row] < end) f(row, rows.index[row]);
    });
}

/// Adds each row to its record.
template <class T>
void add_rows(const rows_of<T>& rows) {
    for_each_row(rows, [&](std::int64_t row, std::int64_t record) {
        const T* from = rows.values + row * rows.width;
        T* to = rows.table + record * rows.width;
        for (std::int64_t i = 0; i < rows.width; ++i) to[i] = math::wrapping_add(to[i], from[i]);
    });
}

/// Adds each row to its record, with fixed-point sums: the same bits for any order, and as on CUDA.
template <class T>
void add_rows_in_fixed_point(const rows_of<T>& rows) {
    constexpr int limbs = fixed_point<T>::limbs;
    const magnitudes largest = at::parallel_reduce(
        0, rows.n * rows.width, 1 << 15, magnitudes{},
        [&](std::int64_t begin, std::int64_t end, magnitudes found) {
            for (std::int64_t i = begin; i < end; ++i) {
                if (fixed_point<T>::is_finite(rows.values[i]))
                    found.exponent = std::max(found.exponent, fixed_point<T>::exponent(rows.values[i]));
                else
                    found.not_finite = 1;
            }
            return found;
        },
        [](const magnitudes& a, const magnitudes& b) {
            return magnitudes{std::max(a.exponent, b.exponent), std::max(a.not_finite, b.not_finite)};
        });
    const auto format = fixed_point<T>::of(
        largest.exponent, fixed_point<T>::bits_per_value(static_cast<std::uint64_t>(rows.n)));
    const std::int64_t size = rows.records * rows.width;
    std::vector<std::int64_t> sums(static_cast<std::size_t>(limbs * size));
    for_each_row(rows, [&](std::int64_t row, std::int64_t record) {
        const T* from = rows.values + row * rows.width;
        for (int limb = 0; limb < limbs; ++limb) {
            std::int64_t* to = sums.data() + limb * size + record * rows.width;
            for (std::int64_t i = 0; i < rows.width; ++i) to[i] += format.limb(from[i], limb);
        }
    });
    at::parallel_for(0, size, 1 << 15, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            std::int64_t of_value[limbs];
            for (int limb = 0; limb < limbs; ++limb)
                of_value[limb] = sums[static_cast<std::size_t>(limb * size + i)];
            const double sum = format.value(of_value);
            T& to = rows.table[i];
            to = largest.not_finite != 0 ? to + static_cast<T>(sum)
                                         : static_cast<T>(static_cast<double>(to) + sum);
        }
    });
    if (largest.not_finite == 0) return;
    for_each_row(rows, [&](std::int64_t row, std::int64_t record) {
        for (std::int64_t i = 0; i < rows.width; ++i) {
            const T x = rows.values[row * rows.width + i];
            if (!fixed_point<T>::is_finite(x)) rows.table[record * rows.width + i] += x;
        }
    });
}

/// Replaces each value of a record by the largest, or the smallest, of its rows and itself.
template <class T>
void extreme_rows(const rows_of<T>& rows, bool smallest) {
    for_each_row(rows, [&](std::int64_t row, std::int64_t record) {
        const T* from = rows.values + row * rows.width;
        T* to = rows.table + record * rows.width;
        for (std::int64_t i = 0; i < rows.width; ++i)
            to[i] = smallest ? operation::minimum::combine(to[i], from[i])
                             : operation::maximum::combine(to[i], from[i]);
    });
}

}  // namespace warpagg::bindings::cpu
