// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Sums whose bits depend neither on the order of the values nor on the device. The including file has
/// chosen a `backend`. `run(kernel)` runs `kernel(w, index, warps)` in all warps of a launch.

#include <cstdint>
#include <vector>
#include <warpagg/scatter_rows.hpp>

/// Rows of `width` values, the record of each row, and the table of records to which rows are added.
template <class T>
struct rows_to_add {
    unsigned width;
    std::vector<std::int64_t> keys;
    std::vector<T> values, table;
};

/// A launch on the GPU.
struct launch_shape {
    unsigned blocks, warps_per_block;
};

/// Returns the table after a fixed-point scatter.
/// @{
std::vector<float> fixed_point_sums_on_gpu(const rows_to_add<float>& rows, launch_shape shape);
std::vector<double> fixed_point_sums_on_gpu(const rows_to_add<double>& rows, launch_shape shape);
/// @}
/// Returns exact sums of the rows of each record, and then of all rows. The table's values are ignored.
std::vector<float> exact_sums_on_gpu(const rows_to_add<float>& rows, launch_shape shape);

namespace {

template <class Kernel>
struct every_tile {
    Kernel kernel;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, std::size_t index, std::size_t warps) const {
        for (std::size_t i = index; i < kernel.tiles(W::size); i += warps)
            kernel(w, static_cast<unsigned>(i));
    }
};

template <class T, class Run>
std::vector<T> fixed_point_sums(const rows_to_add<T>& of, const Run& run) {
    using namespace warpagg;
    using rows = scatter_rows<T, std::int64_t, row_keys<std::int64_t>, to_fixed_point<T>>;
    constexpr int limbs = fixed_point<T>::limbs;
    const std::size_t size = of.table.size();
    typename backend::template memory<std::int64_t> keys(of.keys),
        sums(std::vector<std::int64_t>(limbs * size));
    typename backend::template memory<T> values(of.values), table(of.table);
    typename backend::template memory<magnitudes> largest(std::vector<magnitudes>(1));
    run(largest_exponent<T>{values.data(), of.values.size(), largest.data()});
    rows all{values.data(), of.keys.size(),
             of.width,      {keys.data(), size / of.width},
             sums.data(),   {largest.data(), of.keys.size()}};
    for (int i = 0; i < limbs; ++i) {
        all.convert.limb = i;
        all.table = sums.data() + i * size;
        if (of.width == 4)
            run(every_tile<scatter_narrow_rows<4, rows>>{{all}});
        else
            run(every_tile<scatter_wide_rows<2, rows>>{{all}});
    }
    all.table = sums.data();
    run(add_fixed_point<rows>{all, size, table.data()});
    return table.download();
}

using exact_cell = warpagg::accumulator<warpagg::accumulate::exact>;

/// A lane adds a row of 4 values to the record of its key, and to the record after the last one.
struct add_exactly {
    const float* values;
    const std::int64_t* keys;
    std::size_t n, records;
    exact_cell* cells;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, std::size_t index, std::size_t warps) const {
        for (std::size_t first = index * W::size; first < n; first += warps * W::size) {
            const bool active = w.lane() < n - first;
            float v[4];
            for (unsigned i = 0; i < 4; ++i) v[i] = w.load(values + first * 4, w.lane() * 4 + i, active);
            const auto key = static_cast<unsigned>(w.load(keys + first, w.lane(), active));
            warpagg::warp_match_reduce_atomic(w, cells, key, v, active, warpagg::policy{warpagg::exact});
            warpagg::warp_reduce_atomic(w, cells + records * 4, v, active, warpagg::policy{warpagg::exact});
        }
    }
};

template <class Run>
std::vector<float> exact_sums(const rows_to_add<float>& of, const Run& run) {
    typename backend::template memory<std::int64_t> keys(of.keys);
    typename backend::template memory<float> values(of.values);
    const std::size_t records = of.table.size() / 4;
    typename backend::template memory<exact_cell> cells(std::vector<exact_cell>((records + 1) * 4));
    run(add_exactly{values.data(), keys.data(), of.keys.size(), records, cells.data()});
    std::vector<float> sums;
    for (const exact_cell& cell : cells.download()) sums.push_back(cell.value());
    return sums;
}

}  // namespace
