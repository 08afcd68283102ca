// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>

#include "../distribute.hpp"
#include "kernel.hpp"

/// The kernels of `cuda::place_lists` and `cuda::write_lists`. The candidates of all items, in the order
/// of the items, are cut into `Slices` of equal length, so that slices do not depend on the sizes of
/// items. A table has a row per slice and a column per bucket. First it holds how many of the slice's
/// candidates go to the bucket, then the place in the bucket's list where they begin.
namespace gs::device::detail {

/// One warp writes the lists of a slice. More slices keep more multiprocessors busy, but the table takes
/// time and memory for each.
inline constexpr unsigned few_slices = 1024, many_slices = 2048;
inline constexpr unsigned counting_warps = 4;  ///< number of warps per slice

/// The largest number of buckets for which a row fits in shared memory.
inline constexpr std::size_t shared_buckets = 48 * 1024 / sizeof(std::uint32_t);

/// Returns the item that has this candidate: the last one with first[item] <= candidate. All lanes
/// of the warp call this with equal arguments. The result is uniform.
__device__ inline std::size_t item_of(const std::uint64_t* first, std::size_t items,
                                      std::uint64_t candidate) {
    std::size_t low = 0, high = items;  // the item is in [low, high)
    while (high - low > 1) {
        const std::size_t step = (high - low + warp_size - 1) / warp_size;
        const std::size_t probe = low + step * lane_of_warp();
        const bool at_or_before = probe < high && first[probe] <= candidate;
        low += step * static_cast<unsigned>(__popc(__ballot_sync(every_lane, at_or_before)) - 1);
        high = low + step < high ? low + step : high;
    }
    return low;
}

/// Distributes the candidates [from, to) over the lanes of a warp, 32 `Rounds` at a time. An item
/// with many candidates takes many lanes, and items with few candidates share a round. Calls
/// f(buckets, values) with `Rounds` elements of each per lane. A lane without a candidate gets
/// `no_bucket`.
template <unsigned Rounds, class Items, class F>
__device__ void for_each_candidate(const Items& items, const std::uint64_t* first, std::size_t count,
                                   std::uint64_t from, std::uint64_t to, const F& f) {
    if (from >= to) return;
    // Each lane holds the end of one of 32 items, relative to `from`.
    for (std::size_t item = item_of(first, count, from), begin = 0; begin < to - from; item += warp_size) {
        const std::size_t mine = item + lane_of_warp() < count ? item + lane_of_warp() + 1 : count;
        const std::uint64_t end_of_mine = first[mine] < to ? first[mine] : to;
        const auto end = static_cast<std::uint32_t>(end_of_mine - from);
        const std::uint32_t last = __shfl_sync(every_lane, end, warp_size - 1);
        for (; begin < last; begin += Rounds * warp_size) {
            std::uint32_t buckets[Rounds], values[Rounds];
#pragma unroll
            for (unsigned r = 0; r < Rounds; ++r) {
                const auto place = static_cast<std::uint32_t>(begin) + r * warp_size + lane_of_warp();
                unsigned before = 0;  // number of items that end at or before this place
#pragma unroll
                for (unsigned step = warp_size / 2; step > 0; step /= 2)
                    if (__shfl_sync(every_lane, end, before + step - 1) <= place) before += step;
                buckets[r] = no_bucket;
                if (place >= last) continue;
                const auto candidate = items(item + before);
                buckets[r] =
                    candidate.bucket(static_cast<std::uint32_t>(from + place - first[item + before]));
                values[r] = candidate.value;
            }
            f(buckets, values);
        }
        begin = last;
    }
}

/// The range [from, to) of candidates in part `part` of the `parts` of a slice.
template <unsigned Slices>
struct slice_of_candidates {
    std::uint64_t from, to;

    __device__ slice_of_candidates(std::uint64_t all, unsigned slice, unsigned part, unsigned parts) {
        const std::uint64_t each = (all + Slices - 1) / Slices, begin = each * slice;
        from = begin + each * part / parts;
        to = begin + each * (part + 1) / parts;
        from = from < all ? from : all;
        to = to < all ? to : all;
    }
};

/// Counts a slice's candidates by bucket. One block per slice.
template <unsigned Slices, bool Shared, class Items>
__global__ void __launch_bounds__(counting_warps* warp_size)
    count_slice(Items items, const std::uint64_t* first, std::size_t count, unsigned buckets,
                std::uint32_t* table) {
    await_kernel_before();
    extern __shared__ std::uint32_t shared_row[];
    std::uint32_t* row = table + std::size_t{blockIdx.x} * buckets;
    std::uint32_t* counts = Shared ? shared_row : row;
    for (unsigned b = threadIdx.x; b < buckets; b += blockDim.x) counts[b] = 0;
    __syncthreads();
    const slice_of_candidates<Slices> mine(first[count], blockIdx.x, threadIdx.x / warp_size, counting_warps);
    for_each_candidate<1>(items, first, count, mine.from, mine.to, [&](const auto& bucket, const auto&) {
        if (bucket[0] != no_bucket) atomicAdd(counts + bucket[0], 1u);
    });
    if (!Shared) return;
    __syncthreads();
    for (unsigned b = threadIdx.x; b < buckets; b += blockDim.x) row[b] = counts[b];
}

inline constexpr unsigned placing_warps = 32;

/// Turns counts into places within each bucket's list, and computes the ranges of the lists. One
/// block handles 32 buckets: each lane handles a bucket, and each warp a part of the slices. The
/// block that finishes last, which the counter `done` determines, computes the ranges. Before that,
/// `ranges[b].end` holds the length of list b.
template <unsigned Slices, class Range>
__global__ void __launch_bounds__(placing_warps* warp_size)
    place_buckets(unsigned buckets, std::uint32_t* table, std::uint64_t capacity, Range* ranges,
                  std::uint64_t* required, unsigned* done) {
    await_kernel_before();
    constexpr unsigned each = Slices / placing_warps;
    __shared__ std::uint32_t sums[placing_warps][warp_size + 1];
    __shared__ bool is_last;
    const unsigned lane = lane_of_warp(), warp = threadIdx.x / warp_size;
    const unsigned bucket = blockIdx.x * warp_size + lane;
    std::uint32_t* const column = table + std::size_t{warp} * each * buckets + bucket;
    std::uint32_t counts[each], sum = 0;
    const std::uint32_t* from = column;
#pragma unroll
    for (unsigned k = 0; k < each; ++k, from += buckets) {
        counts[k] = bucket < buckets ? *from : 0;
        sum += counts[k];
    }
    sums[warp][lane] = sum;
    __syncthreads();
    // Scans across warps: each warp scans the sums of one bucket.
    const std::uint32_t own = sums[lane][warp], through = sum_to_lane(own);
    sums[lane][warp] = through - own;
    if (const unsigned b = blockIdx.x * warp_size + warp; lane == warp_size - 1 && b < buckets)
        ranges[b].end = through;
    __syncthreads();
    std::uint32_t place = sums[warp][lane];
    std::uint32_t* to = column;
#pragma unroll
    for (unsigned k = 0; k < each; ++k, to += buckets) {
        if (bucket < buckets) *to = place;
        place += counts[k];
    }

    __threadfence();
    __syncthreads();
    if (threadIdx.x == 0) is_last = atomicAdd(done, 1u) == gridDim.x - 1;
    __syncthreads();
    if (!is_last) return;
    __threadfence();
    __shared__ std::uint64_t ends[placing_warps];
    __shared__ std::uint64_t end_of_round;
    std::uint64_t begin = 0;
    for (unsigned b = threadIdx.x; b - threadIdx.x < buckets; b += blockDim.x) {
        const std::uint64_t length = b < buckets ? __ldcg(&ranges[b].end) : 0;
        const std::uint64_t end = begin + sum_to_thread<placing_warps>(length, ends);
        if (b < buckets)
            ranges[b] = {static_cast<std::uint32_t>(min(end - length, capacity)),
                         static_cast<std::uint32_t>(min(end, capacity))};
        if (threadIdx.x == blockDim.x - 1) end_of_round = end;
        __syncthreads();
        begin = end_of_round;
    }
    if (threadIdx.x == 0) {
        *required = begin;
        *done = 0;
    }
}

/// Writes the lists. One warp per slice, because the order of candidates in a slice is the order of
/// the lists.
template <unsigned Slices, bool Shared, class Items, class Range>
__global__ void __launch_bounds__(warp_size)
    append_slice(Items items, const std::uint64_t* first, std::size_t count, unsigned buckets,
                 std::uint32_t* table, std::uint64_t most, const Range* ranges, std::uint32_t* listed) {
    await_kernel_before();
    extern __shared__ std::uint32_t shared_row[];
    std::uint32_t* row = table + std::size_t{blockIdx.x} * buckets;
    std::uint32_t* places = Shared ? shared_row : row;
#pragma unroll 8
    for (unsigned b = threadIdx.x; b < buckets; b += warp_size) places[b] = row[b] + ranges[b].begin;
    __syncwarp();
    const slice_of_candidates<Slices> mine(first[count], blockIdx.x, 0, 1);
    constexpr unsigned rounds = 4;
    const auto append = [&](const auto& buckets_of, const auto& values) {
        unsigned peers[rounds];
#pragma unroll
        for (unsigned r = 0; r < rounds; ++r) peers[r] = __match_any_sync(every_lane, buckets_of[r]);
#pragma unroll
        for (unsigned r = 0; r < rounds; ++r) {
            const std::uint32_t bucket = buckets_of[r];
            const bool goes = bucket != no_bucket;
            std::uint32_t place = 0;
            if (goes) {
                place = places[bucket] + lanes_before(peers[r]);
                if (place < most) listed[place] = values[r];
            }
            __syncwarp();
            if (goes && is_last_of(peers[r])) places[bucket] = place + 1;
            __syncwarp();
        }
    };
    for_each_candidate<rounds>(items, first, count, mine.from, mine.to, append);
}

}  // namespace gs::device::detail
