// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Sums of rows by key whose bits do not depend on the order of the rows, against plain atomics and a
/// sort by key. The times include all passes of a variant, and no allocation of memory.

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <bit>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <numeric>
#include <warpagg/scatter_in_blocks.hpp>

#include "scatter_kernel.hpp"

namespace {

constexpr unsigned warps_per_block = threads / 32;

/// The last tiles come first: if the rows were read before, the cache holds their end.
template <class Kernel>
__global__ void __launch_bounds__(threads) each_tile(Kernel kernel, unsigned tiles) {
    const unsigned index = blockIdx.x * warps_per_block + threadIdx.x / 32;
    if (index < tiles) kernel(warpagg::cuda_warp{}, tiles - 1 - index);
}
template <class Kernel>
__global__ void __launch_bounds__(threads) each_warp(Kernel kernel) {
    kernel(warpagg::cuda_warp{}, (std::size_t{blockIdx.x} * threads + threadIdx.x) / 32,
           std::size_t{gridDim.x} * warps_per_block);
}

constexpr unsigned block_threads = 1024;  // of blocks that have copies of records

template <class Scatter>
__global__ void __launch_bounds__(block_threads) each_block(Scatter scatter) {
    extern __shared__ std::int64_t memory[];
    scatter(warpagg::cuda_warp{}, blockIdx.x, threadIdx.x / 32, memory, [] { __syncthreads(); });
}

int multiprocessors() {
    int count = 0;
    check(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, 0));
    return count;
}

template <int Width, class Rows>
using scatter_of = std::conditional_t<Width == 4, warpagg::scatter_narrow_rows<4, Rows>,
                                      warpagg::scatter_wide_rows<2, Rows>>;

/// A warp adds a tile.
struct each_tile_alone {
    template <int Width, class Rows>
    static void launch(const Rows& rows) {
        const scatter_of<Width, Rows> scatter{rows};
        const unsigned tiles = scatter.tiles(32);
        each_tile<<<(tiles - 1) / warps_per_block + 1, threads>>>(scatter, tiles);
    }
};
/// As many blocks as the GPU can run at a time have copies of frequent records.
struct in_blocks {
    template <int Width, class Rows>
    static void launch(const Rows& rows) {
        using scatter = warpagg::scatter_in_blocks<scatter_of<Width, Rows>>;
        constexpr unsigned slots = Width == 4 ? 1024 : 128;
        constexpr int bytes =
            static_cast<int>(scatter::template memory_size<warpagg::cuda_warp>(slots) * sizeof(std::int64_t));
        const auto run = each_block<scatter>;
        static const unsigned blocks = [=] {
            int per_processor = 0;
            check(cudaFuncSetAttribute(run, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes));
            check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&per_processor, run, block_threads, bytes));
            return static_cast<unsigned>(per_processor * multiprocessors());
        }();
        run<<<blocks, block_threads, bytes>>>(scatter{{rows}, slots, blocks, block_threads / 32});
    }
};

/// Warps combine rows by key and add the sums as floats, in any order.
template <int Width>
void add_in_any_order(const scatter_memory<Width>& of) {
    using rows = warpagg::scatter_rows<float, float, warpagg::row_keys<unsigned>>;
    each_tile_alone::launch<Width>(
        rows{of.values.data(), of.rows, Width, {of.key.data(), of.segments}, of.sums.data()});
}

/// Fixed-point sums, which have the same bits for every order of the rows.
template <int Width, class Launch>
class in_fixed_point {
  public:
    void operator()(const scatter_memory<Width>& of) const {
        check(cudaMemsetAsync(limbs_.data(), 0, limbs_.size() * sizeof(std::int64_t)));
        each_warp<<<4 * processors_, threads>>>(
            warpagg::largest_exponent<float>{of.values.data(), of.values.size(), largest_});
        const rows all{of.values.data(),   of.rows, Width, {of.key.data(), of.segments}, limbs_.data(),
                       {largest_, of.rows}};
        Launch::template launch<Width>(all);
        each_warp<<<8 * processors_, threads>>>(
            warpagg::add_fixed_point<rows>{all, of.sums.size(), of.sums.data()});
    }

  private:
    using rows = warpagg::scatter_rows<float, std::int64_t, warpagg::row_keys<unsigned>,
                                       warpagg::to_fixed_point<float>>;

    static constexpr std::size_t sums = std::size_t{scatter_memory<Width>::segments} * Width;

    device_array<std::int64_t> limbs_{sums + 1};  // and the magnitudes, which one call clears with them
    warpagg::magnitudes* largest_ = reinterpret_cast<warpagg::magnitudes*>(limbs_.data() + sums);
    int processors_ = multiprocessors();
};

/// Up to 8 neighboring values of a row, which are at most one sector.
template <int Width>
struct alignas(16) piece {
    static constexpr unsigned size = Width < 8 ? Width : 8, per_row = Width / size;
    float value[size];
};
struct sum_of_pieces {
    template <int Width>
    __host__ __device__ piece<Width> operator()(piece<Width> a, const piece<Width>& b) const {
        for (unsigned i = 0; i < a.size; ++i) a.value[i] += b.value[i];
        return a;
    }
};

/// Item i of the reduction: the pieces of all rows in the order of their keys, one column of pieces
/// after the other.
/// @{
template <int Width>
struct key_of_piece {
    const unsigned* sorted_key;
    __host__ __device__ unsigned operator()(unsigned i) const {
        constexpr unsigned rows = scatter_memory<Width>::rows;
        return sorted_key[i % rows] * piece<Width>::per_row + i / rows;
    }
};
template <int Width>
struct gathered_piece {
    const unsigned* order;
    const piece<Width>* pieces;
    __host__ __device__ piece<Width> operator()(unsigned i) const {
        constexpr unsigned rows = scatter_memory<Width>::rows;
        return pieces[std::size_t{order[i % rows]} * piece<Width>::per_row + i / rows];
    }
};
/// @}

template <class Piece>
__global__ void __launch_bounds__(threads)
    add_pieces(const unsigned* count, const unsigned* key, const Piece* pieces, Piece* sums) {
    const unsigned i = blockIdx.x * threads + threadIdx.x;
    if (i < *count) sums[key[i]] = sum_of_pieces{}(sums[key[i]], pieces[i]);
}

/// CUB sorts the numbers of the rows by key, and reduces the pieces of each key in this order.
template <int Width>
class by_sorting {
  public:
    explicit by_sorting(const scatter_memory<Width>& of) {
        std::vector<unsigned> numbers(of.rows);
        std::iota(numbers.begin(), numbers.end(), 0u);
        check(cudaMemcpy(number_.data(), numbers.data(), numbers.size() * sizeof(unsigned),
                         cudaMemcpyHostToDevice));
        std::size_t to_sort = 0, to_reduce = 0;
        sort(nullptr, to_sort, of);
        reduce(nullptr, to_reduce, of);
        temporary_ = std::make_unique<device_array<char>>(std::max(to_sort, to_reduce));
    }

    void operator()(const scatter_memory<Width>& of) const {
        std::size_t size = temporary_->size();
        sort(temporary_->data(), size, of);
        reduce(temporary_->data(), size, of);
        add_pieces<<<(most_sums + threads - 1) / threads, threads>>>(
            count_.data(), reduced_key_.data(), reduced_.data(),
            reinterpret_cast<piece<Width>*>(of.sums.data()));
    }

  private:
    using memory = scatter_memory<Width>;
    static constexpr unsigned items = memory::rows * piece<Width>::per_row,
                              most_sums = memory::segments * piece<Width>::per_row;

    void sort(void* temporary, std::size_t& size, const memory& of) const {
        check(cub::DeviceRadixSort::SortPairs(temporary, size, of.key.data(), sorted_key_.data(),
                                              number_.data(), order_.data(), static_cast<int>(of.rows), 0,
                                              std::bit_width(of.segments - 1)));
    }
    void reduce(void* temporary, std::size_t& size, const memory& of) const {
        const thrust::counting_iterator<unsigned> item(0);
        check(cub::DeviceReduce::ReduceByKey(
            temporary, size, thrust::make_transform_iterator(item, key_of_piece<Width>{sorted_key_.data()}),
            reduced_key_.data(),
            thrust::make_transform_iterator(
                item, gathered_piece<Width>{order_.data(),
                                            reinterpret_cast<const piece<Width>*>(of.values.data())}),
            reduced_.data(), count_.data(), sum_of_pieces{}, static_cast<int>(items)));
    }
    device_array<unsigned> number_{memory::rows}, sorted_key_{memory::rows}, order_{memory::rows};
    device_array<unsigned> reduced_key_{most_sums}, count_{1};
    device_array<piece<Width>> reduced_{most_sums};
    std::unique_ptr<device_array<char>> temporary_;
};

template <int Width>
kernel_case with_rows_of(keys how, const char* input) {
    using memory = scatter_memory<Width>;
    const auto rows = std::make_shared<memory>(how);
    const auto deterministic = [&]<class Launch>(const char* name, Launch) -> variant {
        const auto sums = std::make_shared<const in_fixed_point<Width, Launch>>();
        return {name, [=] { (*sums)(*rows); }};
    };
    const auto sorted = std::make_shared<const by_sorting<Width>>(*rows);
    kernel_case of = memory::case_of("deterministic scatter", input, rows);
    of.variants = {
        memory::template variant_of<1>("plain atomics", rows, plain_atomics{}),
        {"default", [=] { add_in_any_order(*rows); }},
        deterministic("deterministic", each_tile_alone{}),
        deterministic("deterministic in blocks", in_blocks{}),
        {"sort and reduce by key", [=] { (*sorted)(*rows); }},
    };
    return of;
}

}  // namespace

std::vector<kernel_maker> deterministic_scatter_cases() {
    std::vector<kernel_maker> all;
    for (const auto& in : key_distributions) {
        all.push_back([=] { return with_rows_of<4>(in.how, in.name); });
        all.push_back([=] { return with_rows_of<64>(in.how, in.name); });
    }
    return all;
}
