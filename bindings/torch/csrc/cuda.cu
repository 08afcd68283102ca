// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <warpagg/atomic.hpp>
#include <warpagg/scatter_rows.hpp>

#include "cuda.hpp"

#undef NDEBUG
#include <cassert>

namespace warpagg::bindings::cuda_device {
namespace {

constexpr unsigned threads = 256, warps_per_block = threads / 32;

/// Works as `row_keys`, and asserts that every row is inside.
struct asserted_keys : row_keys<std::int64_t> {
    template <class W>
    __device__ unsigned operator()(const W& w, std::size_t row, bool& inside) const {
        const bool was_inside = inside;
        const unsigned key = row_keys::operator()(w, row, inside);
        assert(inside == was_inside && "warpagg: an index is out of range");
        return key;
    }
};

/// The last tiles come first: if the rows were read before, the cache holds their end.
template <class Kernel>
__global__ void __launch_bounds__(threads) each_tile(Kernel kernel, unsigned tiles) {
    const unsigned index = blockIdx.x * warps_per_block + threadIdx.x / 32;
    if (index < tiles) kernel(cuda_warp{}, tiles - 1 - index);
}
template <class Kernel>
__global__ void __launch_bounds__(threads) each_warp(Kernel kernel) {
    kernel(cuda_warp{}, (std::size_t{blockIdx.x} * threads + threadIdx.x) / 32,
           std::size_t{gridDim.x} * warps_per_block);
}

template <class Kernel>
cudaError_t launch_tiles(const Kernel& kernel, cudaStream_t stream) {
    const unsigned tiles = kernel.tiles(32);
    if (tiles == 0) return cudaSuccess;
    each_tile<<<(tiles - 1) / warps_per_block + 1, threads, 0, stream>>>(kernel, tiles);
    return cudaGetLastError();
}
/// With at most `tiles` warps, and not more blocks than the GPU can run at a time.
template <class Kernel>
cudaError_t launch_warps(const Kernel& kernel, std::size_t tiles, unsigned blocks_per_processor,
                         cudaStream_t stream) {
    int device = 0, processors = 0;
    if (const cudaError_t error = cudaGetDevice(&device); error != cudaSuccess) return error;
    if (const cudaError_t error = cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device);
        error != cudaSuccess)
        return error;
    const std::size_t blocks =
        std::min((tiles + warps_per_block - 1) / warps_per_block,
                 std::size_t{blocks_per_processor} * static_cast<unsigned>(processors));
    if (blocks > 0) each_warp<<<static_cast<unsigned>(blocks), threads, 0, stream>>>(kernel);
    return cudaGetLastError();
}

template <class T>
bool is_aligned(const T* address) {
    return reinterpret_cast<std::uintptr_t>(address) % 16 == 0;
}

/// Scatters rows by the kernel for their width.
template <class Rows>
cudaError_t launch_scatter(const Rows& rows, cudaStream_t stream) {
    constexpr std::size_t most_keys = std::size_t{1} << 32;
    if (rows.n == 0 || rows.width == 0) return cudaSuccess;
    const std::size_t records = rows.keys.records;
    if (rows.width % 4 == 0 && rows.width <= 16 && records * (rows.width / 4) <= most_keys &&
        is_aligned(rows.values) && is_aligned(rows.table))
        return launch_tiles(scatter_narrow_rows<4, Rows>{rows}, stream);
    if (rows.width < 16 && records * rows.width <= most_keys)
        return launch_tiles(scatter_narrow_rows<1, Rows>{rows}, stream);
    if (rows.width <= 32) return launch_tiles(scatter_wide_rows<1, Rows>{rows}, stream);
    if (rows.width <= 64) return launch_tiles(scatter_wide_rows<2, Rows>{rows}, stream);
    return launch_tiles(scatter_wide_rows<4, Rows>{rows}, stream);
}

asserted_keys keys_of(const std::int64_t* index, std::int64_t records) {
    return {{index, static_cast<std::size_t>(records)}};
}

template <class Op, class T>
cudaError_t combine_rows(const rows_of<T>& rows, cudaStream_t stream) {
    using scatter = scatter_rows<T, T, asserted_keys, unchanged, Op>;
    return launch_scatter(
        scatter{rows.values, static_cast<std::size_t>(rows.n), static_cast<unsigned>(rows.width),
                keys_of(rows.index, rows.records), rows.table},
        stream);
}

}  // namespace

template <class T>
cudaError_t add_rows(const rows_of<T>& rows, cudaStream_t stream) {
    return combine_rows<operation::sum>(rows, stream);
}

template <class T>
cudaError_t add_rows_in_fixed_point(const rows_of<T>& rows, std::int64_t* scratch, cudaStream_t stream) {
    using scatter = scatter_rows<T, std::int64_t, asserted_keys, to_fixed_point<T>>;
    const auto n = static_cast<std::size_t>(rows.n), width = static_cast<std::size_t>(rows.width);
    const std::size_t size = static_cast<std::size_t>(rows.records) * width;
    auto* largest = reinterpret_cast<magnitudes*>(scratch + fixed_point<T>::limbs * size);
    scatter all{rows.values, n,           static_cast<unsigned>(width), keys_of(rows.index, rows.records),
                scratch,     {largest, n}};

    const largest_exponent<T> find{rows.values, n * width, largest};
    cudaError_t error = launch_warps(find, find.tiles(32), 4, stream);
    for (int limb = 0; limb < fixed_point<T>::limbs && error == cudaSuccess; ++limb) {
        all.convert.limb = limb;
        all.table = scratch + limb * size;
        error = launch_scatter(all, stream);
    }
    if (error != cudaSuccess) return error;
    all.table = scratch;
    return launch_warps(add_fixed_point<scatter>{all, size, rows.table}, (size + 31) / 32, 8, stream);
}

template <class T>
cudaError_t extreme_rows(const rows_of<T>& rows, bool smallest, cudaStream_t stream) {
    return smallest ? combine_rows<operation::minimum>(rows, stream)
                    : combine_rows<operation::maximum>(rows, stream);
}

template cudaError_t add_rows(const rows_of<float>&, cudaStream_t);
template cudaError_t add_rows(const rows_of<double>&, cudaStream_t);
template cudaError_t add_rows(const rows_of<std::int32_t>&, cudaStream_t);
template cudaError_t add_rows(const rows_of<std::int64_t>&, cudaStream_t);
template cudaError_t add_rows_in_fixed_point(const rows_of<float>&, std::int64_t*, cudaStream_t);
template cudaError_t add_rows_in_fixed_point(const rows_of<double>&, std::int64_t*, cudaStream_t);
template cudaError_t extreme_rows(const rows_of<float>&, bool, cudaStream_t);
template cudaError_t extreme_rows(const rows_of<double>&, bool, cudaStream_t);
template cudaError_t extreme_rows(const rows_of<std::int32_t>&, bool, cudaStream_t);
template cudaError_t extreme_rows(const rows_of<std::int64_t>&, bool, cudaStream_t);

}  // namespace warpagg::bindings::cuda_device
