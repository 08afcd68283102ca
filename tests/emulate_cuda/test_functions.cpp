// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// CUDA's functions and variables on the emulator.

#include <cooperative_groups.h>
#include <cooperative_groups/reduce.h>

#include <type_traits>

#include "../support/for_each_seed.hpp"
#include "scenes.hpp"

using warpagg::emulator::diagnosis;

namespace {

constexpr unsigned all_lanes = 0xffffffffu;

/// Runs a kernel on one block, and returns the values that its threads wrote.
template <class T>
std::vector<T> results(void (*kernel)(T*), cuda_grid g = {}) {
    device_array<T> to(g.threads.x * g.threads.y * g.threads.z);
    CHECK(try_launch(kernel, g, to).text() == "");
    return {to.begin(), to.end()};
}

__global__ void write_indices(uint4* threads, uint4* blocks) {
    const unsigned in_block = threadIdx.x + blockDim.x * (threadIdx.y + blockDim.y * threadIdx.z);
    const unsigned block = blockIdx.x + gridDim.x * (blockIdx.y + gridDim.y * blockIdx.z);
    const unsigned i = block * blockDim.x * blockDim.y * blockDim.z + in_block;
    threads[i] = make_uint4(threadIdx.x, threadIdx.y, threadIdx.z, i);
    blocks[i] = make_uint4(blockIdx.x, blockIdx.y, blockIdx.z, i);
}

__global__ void shuffles(int4* to) {
    const int lane = static_cast<int>(threadIdx.x);
    to[lane] = make_int4(__shfl_sync(all_lanes, lane, 9, 8), __shfl_up_sync(all_lanes, lane, 3, 8),
                         __shfl_down_sync(all_lanes, lane, 3, 8), __shfl_xor_sync(all_lanes, lane, 5));
}
struct triple {
    char a;
    short b;
    double c;
};
__global__ void tile_shuffles(int4* to) {
    namespace cg = cooperative_groups;
    const auto tile = cg::tiled_partition<8>(cg::this_thread_block());
    const int lane = static_cast<int>(threadIdx.x);
    const triple t = tile.shfl(triple{static_cast<char>(lane), 2, 0.5 * lane}, 9);
    const bool whole =
        t.a == static_cast<char>(lane / 8 * 8 + 1) && t.b == 2 && t.c == 0.5 * (lane / 8 * 8 + 1);
    to[lane] =
        make_int4(whole ? 1 : 0, tile.shfl_up(lane, 3), tile.shfl_down(lane, 3), tile.shfl_xor(lane, 5));
}
__global__ void tile_votes(uint4* to) {
    namespace cg = cooperative_groups;
    const cg::thread_block block = cg::this_thread_block();
    const auto tile = cg::tiled_partition<4>(cg::tiled_partition<16>(block));
    const unsigned lane = block.thread_rank();
    to[lane] = make_uint4(
        tile.ballot(lane % 3 == 0), static_cast<unsigned>(tile.any(lane == 5)),
        static_cast<unsigned>(tile.all(lane >= 4)),
        cg::reduce(tile, lane, cg::greater<unsigned>()) * 100 + cg::reduce(tile, lane, cg::less<unsigned>()));
    tile.sync();
    cg::sync(block);
}
__global__ void votes(uint4* to) {
    const unsigned lane = threadIdx.x;
    to[lane] = make_uint4(__ballot_sync(all_lanes, lane % 3 == 0), __match_any_sync(all_lanes, lane / 10),
                          static_cast<unsigned>(__any_sync(all_lanes, lane == 5)),
                          static_cast<unsigned>(__all_sync(all_lanes, lane < 31)));
    __syncwarp();
}
__global__ void barrier_counts(int3* to) {
    const int rank = static_cast<int>(threadIdx.x);
    for (int round = 0; round < 3; ++round) {
        const int count = __syncthreads_count(rank < 10 + round);
        to[rank].x = count;
        if (count != 10 + round) return;
    }
    to[rank].y = __syncthreads_or(rank == 3);
    to[rank].z = __syncthreads_and(rank != 3);
}

struct words {
    unsigned add, sub, low, high, both, either, parity, exchanged, swapped, up, down;
};
__global__ void atomics(words* w, int* low, float* f, double* d, unsigned long long* l) {
    const unsigned i = threadIdx.x;
    atomicAdd(&w->add, i);
    atomicSub(&w->sub, i);
    atomicMin(&w->low, i + 7);
    atomicMax(&w->high, i);
    atomicAnd(&w->both, ~(1u << i));
    atomicOr(&w->either, 1u << i);
    atomicXor(&w->parity, 1u << (i / 2));
    atomicExch(&w->exchanged, 9);
    atomicCAS(&w->swapped, i, i + 1);
    atomicInc(&w->up, 20);
    atomicDec(&w->down, 20);
    atomicMin(low, -static_cast<int>(i));
    atomicAdd(f, 0.5f);
    atomicAdd(d, 0.5);
    atomicAdd(l, 1ull << 33);
}
__global__ void atomic_results(unsigned* counter, unsigned* order) {
    order[atomicAdd(counter, 1)] = threadIdx.x;
}

__global__ void tell_size(unsigned* to) {
    const auto block = cooperative_groups::this_thread_block();
    to[blockIdx.x * block.size() + block.thread_rank()] = block.size();
}
__global__ void reduce_by_warp(float* sum) {
    const float one[1] = {1};
    warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, sum, one, threadIdx.x % 2 == 0);
}
__global__ void reduce_by_wide_key(float* sums) {
    const std::uint64_t far = std::uint64_t{1} << 32, key = threadIdx.x % 2 * far;
    const float one[1] = {1};
    const auto base = [sums](std::uint64_t k, unsigned) { return sums + (k >= far ? 1 : 0); };
    warpagg::warp_match_reduce_atomic(warpagg::cuda_warp{}, base, key, one, threadIdx.x < 30);
}
__global__ void skip_and_reduce(float* sums) {
    const float one[1] = {1};
    for (int i = 0; i < 2; ++i) {
        if (threadIdx.x < 8 && i == 0) continue;
        warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, sums + i, one, true);
    }
}

}  // namespace

TEST_CASE("indices of threads and blocks in three dimensions") {
    const dim3 blocks(2, 3, 2), threads(4, 3, 5);
    device_array<uint4> in_block(12 * 60), in_grid(12 * 60);
    CHECK(try_launch(write_indices, {blocks, threads}, in_block, in_grid).text() == "");
    unsigned i = 0;
    for (unsigned bz = 0; bz < 2; ++bz)
        for (unsigned by = 0; by < 3; ++by)
            for (unsigned bx = 0; bx < 2; ++bx)
                for (unsigned z = 0; z < 5; ++z)
                    for (unsigned y = 0; y < 3; ++y)
                        for (unsigned x = 0; x < 4; ++x, ++i) {
                            const uint4 t = in_block[i], b = in_grid[i];
                            CHECK((t.x == x && t.y == y && t.z == z && t.w == i));
                            CHECK((b.x == bx && b.y == by && b.z == bz && b.w == i));
                        }
}

TEST_CASE("shuffles within parts of a warp") {
    const std::vector<int4> plain = results(shuffles), tiles = results(tile_shuffles);
    for (int lane = 0; lane < 32; ++lane) {
        const auto i = static_cast<unsigned>(lane);
        CHECK(plain[i].x == lane / 8 * 8 + 1);
        CHECK(tiles[i].x == 1);
        CHECK(plain[i].y == (lane % 8 < 3 ? lane : lane - 3));
        CHECK(tiles[i].y == plain[i].y);
        CHECK(plain[i].z == (lane % 8 > 4 ? lane : lane + 3));
        CHECK(tiles[i].z == plain[i].z);
        CHECK(plain[i].w == (lane ^ 5));
        CHECK(tiles[i].w == plain[i].w);
    }
}

TEST_CASE("votes") {
    const std::vector<uint4> plain = results(votes), tiles = results(tile_votes);
    for (unsigned lane = 0; lane < 32; ++lane) {
        CHECK(plain[lane].x == 0x49249249u);
        CHECK(plain[lane].y == (lane < 10   ? 0x3ffu
                                : lane < 20 ? 0xffc00u
                                : lane < 30 ? 0x3ff00000u
                                            : 0xc0000000u));
        CHECK(plain[lane].z == 1);
        CHECK(plain[lane].w == 0);
        const unsigned first = lane / 4 * 4;
        CHECK(tiles[lane].x == ((0x49249249u >> first) & 15u));
        CHECK(tiles[lane].y == (first == 4 ? 1 : 0));
        CHECK(tiles[lane].z == (first >= 4 ? 1 : 0));
        CHECK(tiles[lane].w == (first + 3) * 100 + first);
    }
}

TEST_CASE("barriers that count") {
    for (const unsigned threads : {96u, 100u})
        for (const int3& v : results(barrier_counts, {.threads = threads}))
            CHECK((v.x == 12 && v.y == 1 && v.z == 0));
}

TEST_CASE("atomics") {
    device_array<words> w(1, {0, 1000, 100, 0, all_lanes, 0, 0, 0, 5, 0, 20});
    device_array<int> low{0};
    device_array<float> f{0};
    device_array<double> d{0};
    device_array<unsigned long long> l{0ull};
    CHECK(try_launch(atomics, {}, w, low, f, d, l).text() == "");
    CHECK(w[0].add == 496);
    CHECK(w[0].sub == 504);
    CHECK(w[0].low == 7);
    CHECK(w[0].high == 31);
    CHECK(w[0].both == 0);
    CHECK(w[0].either == all_lanes);
    CHECK(w[0].parity == 0);
    CHECK(w[0].exchanged == 9);
    CHECK((w[0].swapped > 5 && w[0].swapped <= 32));
    CHECK(w[0].up == 32 % 21);
    CHECK(w[0].down == 20 - 32 % 21);
    CHECK(low[0] == -31);
    CHECK(f[0] == 16);
    CHECK(d[0] == 16);
    CHECK(l[0] == 1ull << 38);

    device_array<unsigned> counter{0u}, order(32);
    CHECK(try_launch(atomic_results, {}, counter, order).text() == "");
    std::vector<unsigned> sorted(order.begin(), order.end());
    std::ranges::sort(sorted);
    for (unsigned i = 0; i < 32; ++i) CHECK(sorted[i] == i);
}

TEST_CASE("functions of one thread") {
    CHECK(__popc(0xf0u) == 4);
    CHECK(__popcll(1ull << 40) == 1);
    CHECK(__clz(1) == 31);
    CHECK(__clzll(1) == 63);
    CHECK((__ffs(0) == 0 && __ffs(8) == 4));
    CHECK((__ffsll(0) == 0 && __ffsll(1ll << 40) == 41));
    CHECK(__brev(0xb0000001u) == 0x8000000du);
    CHECK(__float_as_uint(1.0f) == 0x3f800000u);
    CHECK(__float_as_int(-0.0f) == static_cast<int>(0x80000000u));
    CHECK((__uint_as_float(0x3f800000u) == 1 && __int_as_float(0x40000000) == 2));
    CHECK((__expf(0) == 1 && __logf(1) == 0 && __powf(2, 3) == 8 && __sinf(0) == 0 && __cosf(0) == 1));
    CHECK((__fdividef(3, 2) == 1.5f && __frcp_rn(4) == 0.25f && __fsqrt_rn(9) == 3));
    CHECK((abs(-0.5f) == 0.5f && sqrt(4.0f) == 2.0f && fabsf(-2.0f) == 2));
    CHECK((rsqrtf(4) == 0.5f && rsqrt(4.0) == 0.5));
    CHECK((__saturatef(-1) == 0 && __saturatef(0.5f) == 0.5f && __saturatef(2) == 1));
    CHECK((min(2, 3) == 2 && max(2.0f, 3) == 3.0f && min(2u, 3u) == 2u));
    static_assert(sizeof(float3) == 12 && alignof(float4) == 16 && alignof(int2) == 8);
    static_assert(std::is_trivially_copyable_v<float4>);
}

TEST_CASE("blocks of any size") {
    for (const unsigned v : results(tell_size, {.threads = 100})) CHECK(v == 100);
    device_array<unsigned> sizes(64);
    warpagg::emulator::launch(tell_size, 2, dim3(4, 2, 4), sizes);
    CHECK((sizes[0] == 32 && sizes[63] == 32));
    device_array<float> sum{0};
    CHECK(try_launch(reduce_by_warp, {.threads = 64}, sum).text() == "");
    CHECK(sum[0] == 32);
    const report r = try_launch(reduce_by_warp, {.threads = 40}, sum);
    CHECK(r.what == diagnosis::collective_not_reached);
    CHECK(r.sentence ==
          "Lanes 0-7 wait for lanes 8-31 in warp_reduce_atomic, but lanes 8-31 do not exist in this block.");
}

TEST_CASE("keys of 64 bits that differ in their upper halves only") {
    device_array<float> sums{0, 0};
    CHECK(try_launch(reduce_by_wide_key, {}, sums).text() == "");
    CHECK(sums[0] == 15);
    CHECK(sums[1] == 15);
}

TEST_CASE("the destination after a continue") {
    device_array<float> sums{0, 0};
    for_each_seed(200, [&](std::uint64_t seed) {
        const report r = try_launch(skip_and_reduce, {.seed = seed}, sums);
        CHECK(r.what == diagnosis::destination_not_uniform);
        CHECK(r.sentence.ends_with(". A likely cause is a continue or an early return before the call."));
    });
}
