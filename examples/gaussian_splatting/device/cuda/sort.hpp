// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>

#include <cstdint>
#include <cuda/atomic>

#include "kernel.hpp"

/// The kernels of `cuda::sort_pairs`: a stable radix sort, from the lowest digit on, with one
/// launch per digit (Adinolfi and Merrill, "Onesweep", 2022). CUB's sort is tuned for tens of
/// millions of keys. This sort has half as many launches, and its smaller tiles keep a GPU busy
/// with a hundred thousand keys.
namespace gs::device::detail {

inline constexpr unsigned digit_bits = 8, digits = 1u << digit_bits;
inline constexpr unsigned digits_a_key = 32 / digit_bits;
inline constexpr unsigned sorting_threads = digits, sorting_warps = sorting_threads / warp_size;
inline constexpr unsigned keys_a_thread = 8, keys_a_tile = keys_a_thread * sorting_threads;

__device__ inline std::uint32_t digit_of(std::uint32_t key, unsigned shift) {
    return key >> shift & (digits - 1);
}

/// The memory that the launches of a sort share, zero at first. For one digit it has the histogram
/// of all keys, the number of tiles that have begun, and a histogram of `digits` values per tile.
/// The highest two bits of a tile's values tell whether they are known, and whether they count this
/// tile or all tiles so far.
struct sort_memory {
    std::uint32_t* histograms;
    std::uint32_t* begun;
    std::uint32_t* known;

    static constexpr std::uint32_t of_this_tile = 1u << 30, of_all_so_far = 1u << 31,
                                   counts = of_this_tile - 1;

    static std::size_t size(unsigned tiles) {
        return digits_a_key * (digits + 1 + std::size_t{tiles} * digits);
    }
    sort_memory(std::uint32_t* all, unsigned tiles, unsigned digit)
        : histograms(all + digit * digits),
          begun(all + digits_a_key * digits + digit),
          known(all + digits_a_key * (digits + 1) + std::size_t{digit} * tiles * digits) {}
};

/// Computes the histograms of all digits of the keys.
template <class Key>
__global__ void __launch_bounds__(sorting_threads)
    count_digits(const Key* keys, unsigned n, std::uint32_t* histograms) {
    await_kernel_before();
    __shared__ std::uint32_t counts[digits_a_key][digits];
    for (auto& count : counts) count[threadIdx.x] = 0;
    __syncthreads();
#pragma unroll 4
    for (unsigned i = blockIdx.x * sorting_threads + threadIdx.x; i < n; i += gridDim.x * sorting_threads) {
        const Key key = keys[i];
        for (unsigned d = 0; d < digits_a_key; ++d) atomicAdd(&counts[d][digit_of(key, d * digit_bits)], 1u);
    }
    __syncthreads();
    for (unsigned d = 0; d < digits_a_key; ++d)
        if (const std::uint32_t count = counts[d][threadIdx.x]; count > 0)
            atomicAdd(histograms + d * digits + threadIdx.x, count);
}

/// Returns how many keys of all previous tiles have the digit whose value is the thread's index.
__device__ inline std::uint32_t count_before(const std::uint32_t* known, unsigned tile) {
    const auto look = [&](unsigned t) {
        return cuda::atomic_ref<const std::uint32_t, cuda::thread_scope_device>(
                   known[t * digits + threadIdx.x])
            .load(cuda::memory_order_relaxed);
    };
    constexpr unsigned together = 4;
    std::uint32_t sum = 0;
    for (unsigned t = tile;; t -= together) {
        std::uint32_t seen[together];
#pragma unroll
        for (unsigned k = 0; k < together; ++k)
            seen[k] = k < t ? look(t - 1 - k) : sort_memory::of_all_so_far;
#pragma unroll
        for (unsigned k = 0; k < together; ++k) {
            while ((seen[k] & ~sort_memory::counts) == 0) seen[k] = look(t - 1 - k);
            sum += seen[k] & sort_memory::counts;
            if (seen[k] & sort_memory::of_all_so_far) return sum;
        }
    }
}

/// Ranks each key among the keys of its warp with the same digit, and adds the keys to the warp's
/// counts. All lanes of the warp call this together.
template <class Key>
__device__ __forceinline__ void rank_in_warp(const Key (&key)[keys_a_thread], unsigned shift,
                                             std::uint32_t (&counts)[digits],
                                             std::uint32_t (&rank)[keys_a_thread]) {
#pragma unroll
    for (unsigned k = 0; k < keys_a_thread; ++k) {
        const std::uint32_t digit = digit_of(key[k], shift);
        unsigned peers = every_lane;
#pragma unroll
        for (unsigned bit = 0; bit < digit_bits; ++bit) {
            const bool one = digit >> bit & 1;
            const unsigned ones = __ballot_sync(every_lane, one);
            peers &= one ? ones : ~ones;
        }
        rank[k] = counts[digit] + lanes_before(peers);
        __syncwarp();
        if (is_last_of(peers)) counts[digit] = rank[k] + 1;
        __syncwarp();
    }
}

/// Writes the sorted pairs of a tile to their places. The tile begins at pair `first` of n. `moved`
/// has, for each digit, the distance from a pair's place in the tile to its place in the result.
/// All threads of the block call this together.
template <class Key, class Value>
__device__ __forceinline__ void write_sorted(const Key* sorted_keys, const Value* sorted_values,
                                             const std::uint32_t* moved, unsigned shift, unsigned first,
                                             unsigned n, Key* to_keys, Value* to_values) {
#pragma unroll
    for (unsigned k = 0; k < keys_a_thread; ++k) {
        const unsigned place = k * sorting_threads + threadIdx.x;
        if (first + place >= n) break;
        const std::uint32_t to = moved[digit_of(sorted_keys[place], shift)] + place;
        to_keys[to] = sorted_keys[place];
        to_values[to] = sorted_values[place];
    }
}

/// Sorts the pairs by one digit. One block per tile of pairs.
template <class Key, class Value>
__global__ void __launch_bounds__(sorting_threads)
    sort_by_digit(const Key* keys, const Value* values, unsigned n, unsigned shift, sort_memory memory,
                  Key* to_keys, Value* to_values) {
    await_kernel_before();
    __shared__ unsigned my_tile;
    __shared__ std::uint32_t counts[sorting_warps][digits];
    __shared__ std::uint32_t moved[digits];
    __shared__ std::uint64_t sums[sorting_warps];
    __shared__ Key sorted_keys[keys_a_tile];
    __shared__ Value sorted_values[keys_a_tile];
    // Tiles are numbered in the order in which blocks begin, so that no block waits for one not yet
    // begun.
    if (threadIdx.x == 0) my_tile = atomicAdd(memory.begun, 1u);
    for (auto& count : counts) count[threadIdx.x] = 0;
    __syncthreads();

    const unsigned tile = my_tile, first = tile * keys_a_tile, warp = threadIdx.x / warp_size;
    const unsigned mine = first + warp * keys_a_thread * warp_size + lane_of_warp();
    // The tile is padded with the largest key, which sorts last and is not written.
    Key key[keys_a_thread];
    std::uint32_t rank[keys_a_thread];  // rank among the warp's keys with the same digit
#pragma unroll
    for (unsigned k = 0; k < keys_a_thread; ++k) {
        const unsigned i = mine + k * warp_size;
        key[k] = i < n ? keys[i] : ~Key{0};
    }
    rank_in_warp(key, shift, counts[warp], rank);
    __syncthreads();

    // From here on, each thread handles one value of the digit.
    std::uint32_t count = 0;
    for (auto& of_warp : counts) {
        const std::uint32_t own = of_warp[threadIdx.x];
        of_warp[threadIdx.x] = count;
        count += own;
    }
    cuda::atomic_ref<std::uint32_t, cuda::thread_scope_device> known(
        memory.known[tile * digits + threadIdx.x]);
    known.store(count | (tile == 0 ? sort_memory::of_all_so_far : sort_memory::of_this_tile),
                cuda::memory_order_relaxed);
    const std::uint64_t own = std::uint64_t{memory.histograms[threadIdx.x]} << 32 | count;
    const std::uint64_t smaller = sum_to_thread<sorting_warps>(own, sums) - own;
    const auto in_tile = static_cast<std::uint32_t>(smaller),
               in_all = static_cast<std::uint32_t>(smaller >> 32);
    const std::uint32_t before = count_before(memory.known, tile);
    if (tile > 0) known.store((before + count) | sort_memory::of_all_so_far, cuda::memory_order_relaxed);
    moved[threadIdx.x] = in_all + before - in_tile;
    for (auto& of_warp : counts) of_warp[threadIdx.x] += in_tile;
    __syncthreads();

#pragma unroll
    for (unsigned k = 0; k < keys_a_thread; ++k) {
        const unsigned i = mine + k * warp_size;
        const std::uint32_t place = counts[warp][digit_of(key[k], shift)] + rank[k];
        sorted_keys[place] = key[k];
        if (i < n) sorted_values[place] = values[i];
    }
    __syncthreads();
    write_sorted(sorted_keys, sorted_values, moved, shift, first, n, to_keys, to_values);
}

}  // namespace gs::device::detail
