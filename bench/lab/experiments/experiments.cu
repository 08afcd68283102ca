// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// How near can the sums of nine floats come to the time of no accumulation at all? Ideas beyond `scatter`,
/// each in the loop of bench_atomics; every one is checked against the exact sum first.

#include <cuda_bf16.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>
#include <warpagg/atomic.hpp>

#include "cuda_figures.hpp"
#include "lab.hpp"

namespace gs::lab {

namespace {

using warp = warpagg::cuda_warp;
using warpagg::policy;
namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;

constexpr unsigned records = 1u << 20, blocks = 132 * 16, threads = 128, steps_per_warp = 2048, seed = 12345;
constexpr int rounds = 7, n = 9, stride = 12;

__device__ void scatter(const warp& w, float (&sums)[n]) {
    reduce::reduce_over_warp<warpagg::operation::sum>(
        reduce::scatter{}, w, [&](int i) { return sums[i]; }, sums);
}

/// An idea adds the values of `batch` steps, each to its own record.
struct nothing {
    static constexpr int batch = 1;
    __device__ void operator()(const warp&, float* const (&)[1], const float (&)[1][n],
                               const bool (&)[1]) const {}
};

template <class Policy>
struct by_policy {
    static constexpr int batch = 1;
    __device__ void operator()(const warp& w, float* const (&to)[1], const float (&v)[1][n],
                               const bool (&active)[1]) const {
        warpagg::warp_reduce_atomic(w, to[0], v[0], active[0], Policy{});
    }
};

/// The masks in a branch of their own.
struct masked_in_a_branch {
    static constexpr int batch = 1;
    __device__ void operator()(const warp& w, float* const (&to)[1], const float (&v)[1][n],
                               const bool (&active)[1]) const {
        const std::uint32_t votes = w.ballot(w.opaque(active[0]));
        if (votes == 0) return;
        float sums[n];
        for (int i = 0; i < n; ++i) sums[i] = v[0][i];
        if (votes != 0xffffffffu) {
            for (int i = 0; i < n; ++i) sums[i] = active[0] ? sums[i] : 0.0f;
            asm volatile("");  // so that it stays a branch
        }
        scatter(w, sums);
        commit::scattered<warpagg::operation::sum>(w, commit::destination(to[0]), sums);
    }
};

/// Nothing is masked where all lanes are active.
struct unmasked_if_full {
    static constexpr int batch = 1;
    __device__ void operator()(const warp& w, float* const (&to)[1], const float (&v)[1][n],
                               const bool (&active)[1]) const {
        const std::uint32_t votes = w.ballot(w.opaque(active[0]));
        if (votes == 0) return;
        const auto record = commit::destination(to[0]);
        float sums[n];
        if (votes == 0xffffffffu) {
            for (int i = 0; i < n; ++i) sums[i] = v[0][i];
            scatter(w, sums);
        } else {
            for (int i = 0; i < n; ++i) sums[i] = active[0] ? v[0][i] : 0.0f;
            scatter(w, sums);
        }
        commit::scattered<warpagg::operation::sum>(w, record, sums);
    }
};

/// The values of several steps are scattered together: 20 shuffles for two steps, 28 for three.
template <int B>
struct batched {
    static constexpr int batch = B;
    struct records_of {
        float* to[B];
        __device__ float* operator()(unsigned i) const {
            float* record = to[0];
            for (int b = 1; b < B; ++b)
                if (i >= static_cast<unsigned>(b * n)) record = to[b] - b * n;
            return record + i;
        }
    };
    __device__ void operator()(const warp& w, float* const (&to)[B], const float (&v)[B][n],
                               const bool (&active)[B]) const {
        records_of where;
        float all[B * n];
        bool any = false;
        for (int b = 0; b < B; ++b) {
            where.to[b] = to[b];
            any = any || active[b];
            for (int i = 0; i < n; ++i) all[b * n + i] = active[b] ? v[b][i] : 0.0f;
        }
        warpagg::warp_reduce_atomic(w, where, all, any, policy<reduce::scatter>{});
    }
};

/// Sums several steps with the same record in registers first; the best possible case.
template <int B>
struct presummed {
    static constexpr int batch = B;
    __device__ void operator()(const warp& w, float* const (&to)[B], const float (&v)[B][n],
                               const bool (&active)[B]) const {
        float all[n] = {};
        bool any = false;
        for (int b = 0; b < B; ++b) {
            any = any || active[b];
            for (int i = 0; i < n; ++i) all[i] += active[b] ? v[b][i] : 0.0f;
        }
        warpagg::warp_reduce_atomic(w, to[0], all, any, policy<reduce::scatter>{});
    }
};

/// Rows to shared memory, and three lanes sum each.
struct through_shared_memory {
    static constexpr int batch = 1;
    __device__ void operator()(const warp& w, float* const (&to)[1], const float (&v)[1][n],
                               const bool (&active)[1]) const {
        constexpr int row = 33;
        __shared__ float rows[threads / 32][n * row];
        float* const mine = rows[threadIdx.x / 32];
        if (!w.any(active[0])) return;
        __syncwarp();
        for (int i = 0; i < n; ++i) mine[i * row + w.lane()] = active[0] ? v[0][i] : 0.0f;
        __syncwarp();
        const unsigned i = w.lane() / 3, part = w.lane() % 3;
        float sum = 0;
        if (i < n)
            for (unsigned k = 0; k < 11; ++k)
                if (part * 11 + k < 32) sum += mine[i * row + part * 11 + k];
        sum += w.shfl_down(sum, 1) + w.shfl_down(sum, 2);
        if (i < n && part == 0) atomicAdd(to[0] + i, sum);
    }
};

/// Each value split into three bfloat16 that add up to it; the tensor cores multiply by ones and so sum over
/// the four lanes of a quad, four values at a time; two shuffles do the rest.
struct tensor_cores {
    static constexpr int batch = 1;
    static constexpr std::uint32_t one_low = 0x3f80u, one_high = 0x3f800000u;

    __device__ static void multiply(float (&d)[4], const std::uint32_t (&a)[4], std::uint32_t b0,
                                    std::uint32_t b1) {
        asm volatile(
            "mma.sync.aligned.m16n8k16.row.col.f32.bf16.bf16.f32 {%0,%1,%2,%3}, {%4,%5,%6,%7}, {%8,%9}, "
            "{%0,%1,%2,%3};"
            : "+f"(d[0]), "+f"(d[1]), "+f"(d[2]), "+f"(d[3])
            : "r"(a[0]), "r"(a[1]), "r"(a[2]), "r"(a[3]), "r"(b0), "r"(b1));
    }
    /// The upper halves of two floats.
    __device__ static std::uint32_t upper(float low, float high) {
        return __byte_perm(__float_as_uint(low), __float_as_uint(high), 0x7632);
    }
    __device__ static float rest(float x) { return x - __uint_as_float(__float_as_uint(x) & 0xffff0000u); }

    __device__ void operator()(const warp& w, float* const (&to)[1], const float (&v)[1][n],
                               const bool (&active)[1]) const {
        if (!w.any(active[0])) return;
        const unsigned group = w.lane() / 4, in_group = w.lane() % 4;
        float d[4] = {};
        float x[12];
        for (int i = 0; i < 12; ++i) x[i] = i < n && active[0] ? v[0][i < n ? i : 0] : 0.0f;
        for (unsigned p = 0; p < 3; ++p) {  // rows 4p to 4p + 3 of the product are values 4p to 4p + 3
            const unsigned row = p < 2 ? group : group + 8;
            const std::uint32_t first = (row == 4 * p ? one_low : 0u) | (row == 4 * p + 1 ? one_high : 0u);
            const std::uint32_t second =
                (row == 4 * p + 2 ? one_low : 0u) | (row == 4 * p + 3 ? one_high : 0u);
            const std::uint32_t a[4] = {p < 2 ? first : 0u, p < 2 ? 0u : first, p < 2 ? second : 0u,
                                        p < 2 ? 0u : second};
            for (int part = 0; part < 3; ++part) {
                multiply(d, a, upper(x[4 * p], x[4 * p + 1]), upper(x[4 * p + 2], x[4 * p + 3]));
                for (unsigned i = 4 * p; i < 4 * p + 4; ++i) x[i] = rest(x[i]);
            }
        }
        const float lower = d[0] + d[1], higher = d[2] + d[3];
        const bool odd = (in_group & 1u) != 0;
        float sum = (odd ? higher : lower) + w.shfl_xor(odd ? lower : higher, 1);
        sum += w.shfl_xor(sum, 2);
        const unsigned index = group + (odd ? 8 : 0);
        if (in_group < 2 && index < n) atomicAdd(to[0] + index, sum);
    }
};

/// The record to memory by one bulk reduction from shared memory.
struct bulk_commit {
    static constexpr int batch = 1;
    __device__ void operator()(const warp& w, float* const (&to)[1], const float (&v)[1][n],
                               const bool (&active)[1]) const {
        __shared__ alignas(16) float staged[threads / 32][stride];
        float* const mine = staged[threadIdx.x / 32];
        if (!w.any(active[0])) return;
        float sums[n];
        for (int i = 0; i < n; ++i) sums[i] = active[0] ? v[0][i] : 0.0f;
        scatter(w, sums);
        const unsigned index = reduce::scattered_index(w, 0);
        if (w.lane() == 0) asm volatile("cp.async.bulk.wait_group.read 0;" ::: "memory");
        __syncwarp();
        if (index < stride) mine[index] = index < n ? sums[0] : 0.0f;
        asm volatile("fence.proxy.async.shared::cta;" ::: "memory");
        __syncwarp();
        if (w.lane() == 0) {
            asm volatile("cp.reduce.async.bulk.global.shared::cta.bulk_group.add.f32 [%0], [%1], %2;" ::"l"(
                             __cvta_generic_to_global(to[0])),
                         "r"(static_cast<unsigned>(__cvta_generic_to_shared(mine))), "n"(stride * 4)
                         : "memory");
            asm volatile("cp.async.bulk.commit_group;" ::: "memory");
        }
    }
};

__device__ std::uint32_t next(std::uint32_t& random) { return random = random * 1664525u + 1013904223u; }

template <class Idea>
__global__ void run(float* memory, std::uint32_t active_below, unsigned steps) {
    constexpr int batch = Idea::batch;
    const warp w;
    const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x;
    std::uint32_t record = seed ^ (thread / 32 * 747796405u), lane = seed ^ (thread * 2891336453u);
    float values[n] = {};
    for (unsigned step = 0; step < steps; step += batch) {
        float* to[batch];
        float v[batch][n];
        bool active[batch];
        for (int b = 0; b < batch; ++b) {
            to[b] = memory + std::size_t{next(record) >> 12} * stride;
            active[b] = active_below == 0 || next(lane) < active_below;
            for (int i = 0; i < n; ++i) v[b][i] = values[i] += 1.0f;
        }
        Idea{}(w, to, v, active);
    }
    if (record == seed)
        for (int i = 0; i < n; ++i) memory[i] = values[i];
    asm volatile("cp.async.bulk.wait_group 0;" ::: "memory");
}

struct idea {
    const char* name;
    void (*launch)(float*, std::uint32_t, unsigned grid, unsigned steps);
    bool adds;
};
template <class Idea>
constexpr idea as(const char* name, bool adds = true) {
    return {name,
            [](float* memory, std::uint32_t below, unsigned grid, unsigned steps) {
                run<Idea><<<grid, threads>>>(memory, below, steps);
            },
            adds};
}
const idea ideas[] = {
    as<nothing>("no accumulation", false),
    as<by_policy<policy<reduce::scatter>>>("scatter"),
    as<by_policy<policy<>>>("the default policy"),
    as<masked_in_a_branch>("scatter, masks in a branch"),
    as<unmasked_if_full>("scatter, unmasked where all lanes are active"),
    as<batched<2>>("scatter of two steps together"),
    as<batched<3>>("scatter of three steps together"),
    as<presummed<2>>("two steps with one record, summed in registers"),
    as<presummed<4>>("four steps with one record, summed in registers"),
    as<through_shared_memory>("transposed through shared memory"),
    as<tensor_cores>("tensor cores, values split into three bfloat16"),
    as<bulk_commit>("scatter, committed by cp.reduce.async.bulk"),
};

/// All that is added in a short run, whose sums are exact in float.
double total(const idea& i, float* memory) {
    std::vector<float> content(std::size_t{records} * stride);
    check(cudaMemset(memory, 0, content.size() * sizeof(float)));
    i.launch(memory, 0x30000000u, 4, 12);
    check(cudaGetLastError());
    check(cudaMemcpy(content.data(), memory, content.size() * sizeof(float), cudaMemcpyDeviceToHost));
    double sum = 0;
    for (std::size_t k = 0; k < content.size(); ++k)
        sum += static_cast<double>(content[k]) * (1.0 + static_cast<double>(k % stride));
    return sum;
}

}  // namespace

int experiments(int argc, char** argv) {
    nlohmann::ordered_json json = figures_of_this_gpu("experiments");
    json["seed"] = seed;
    json["warp_steps"] = std::uint64_t{blocks} * (threads / 32) * steps_per_warp;
    json["records"] = records;
    json["rounds"] = rounds;
    float* memory = nullptr;
    check(cudaMalloc(&memory, sizeof(float) * stride * records));
    bool right = true;
    const double expected = total(ideas[1], memory);
    for (const idea& i : ideas)
        if (i.adds && total(i, memory) != expected) {
            std::printf("%s: adds %.9g instead of %.9g\n", i.name, total(i, memory), expected);
            right = false;
        }
    stopwatch watch;
    std::vector<std::vector<double>> ms[2];
    ms[0].resize(std::size(ideas));
    ms[1].resize(std::size(ideas));
    for (int round = -1; round < rounds; ++round)
        for (int few = 0; few < 2; ++few)
            for (std::size_t k = 0; k < std::size(ideas); ++k) {
                const double t = watch.milliseconds(
                    [&] { ideas[k].launch(memory, few != 0 ? 128849019u : 0u, blocks, steps_per_warp); });
                if (round >= 0) ms[few][k].push_back(t);
            }
    std::printf("| N = 9, float | all lanes | 3 %% |\n| --- | --- | --- |\n");
    for (std::size_t k = 0; k < std::size(ideas); ++k) {
        for (auto& of : ms) std::ranges::sort(of[k]);
        std::printf("| %s | %.2f | %.2f |\n", ideas[k].name, ms[0][k][rounds / 2], ms[1][k][rounds / 2]);
        json["rows"].push_back({{"idea", ideas[k].name},
                                {"ms_all", ms[0][k][rounds / 2]},
                                {"ms_all_least", ms[0][k].front()},
                                {"ms_all_most", ms[0][k].back()},
                                {"ms_3_percent", ms[1][k][rounds / 2]}});
    }
    check(cudaFree(memory));
    if (argc > 1) std::ofstream(argv[1]) << json.dump(1) << '\n';
    return right ? 0 : 1;
}

}  // namespace gs::lab
