// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What warp_match_reduce_atomic costs against plain atomics, by how alike the keys of a warp are.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <type_traits>
#include <vector>
#include <warpagg/atomic.hpp>

#include "cuda_figures.hpp"

namespace {

using warpagg::policy;

constexpr unsigned blocks = 132 * 16, threads = 128, steps = 256, keys = 1u << 20, seed = 12345;
constexpr int rounds = 3;

/// The distribution of a lane's key.
enum class draw { own, rising, rising_far, among, skewed };

template <class T, int N, class Policy>
__global__ void add(T* memory, draw how, unsigned among) {
    const warpagg::cuda_warp w;
    const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x;
    std::uint32_t mine = seed ^ (thread * 2891336453u), ours = seed ^ (thread / 32 * 747796405u);
    T values[N];
    for (int i = 0; i < N; ++i) values[i] = T(i);
    for (unsigned step = 0; step < steps; ++step) {
        mine = mine * 1664525u + 1013904223u;
        ours = ours * 1664525u + 1013904223u;
        for (int i = 0; i < N; ++i) values[i] += T(1);
        unsigned key = 0;
        if (how == draw::own) {
            key = ((ours >> 12) + w.lane() * 7919u) % keys;  // 32 different keys a warp
        } else if (how == draw::rising) {
            key = ((ours >> 12) + w.lane()) % keys;  // neighbors
        } else if (how == draw::rising_far) {
            key = ((ours >> 17) + w.lane() * (keys / 32)) % keys;
        } else if (how == draw::among) {
            key = (mine >> 12) % among;
        } else {  // as words of a text: the k-th most frequent key has a share of about 1 / k
            key = static_cast<unsigned>(exp2f(static_cast<float>(mine >> 8) * (20.0f / 16777216.0f))) - 1u;
        }
        warpagg::warp_match_reduce_atomic(w, memory, key, values, true, Policy{});
    }
}

struct distribution {
    const char* name;
    draw how;
    unsigned among;
};
constexpr distribution distributions[] = {
    {"32 neighbors, rising", draw::rising, 0},
    {"32 apart, rising", draw::rising_far, 0},
    {"32 different", draw::own, 0},
    {"among 2^20", draw::among, 1u << 20},
    {"among 1024", draw::among, 1024},
    {"among 64", draw::among, 64},
    {"among 8", draw::among, 8},
    {"among 4", draw::among, 4},
    {"among 2", draw::among, 2},
    {"all the same", draw::among, 1},
    {"1 / k", draw::skewed, 0},
};

template <class T, int N>
void bench(const char* type, void* memory, nlohmann::ordered_json& rows) {
    stopwatch watch;
    for (const distribution& d : distributions) {
        std::vector<double> plain, matched;
        for (int round = -1; round < rounds; ++round) {
            const double a = watch.milliseconds([&] {
                add<T, N, policy<warpagg::reduce::per_lane>>
                    <<<blocks, threads>>>(static_cast<T*>(memory), d.how, d.among);
            });
            const double b = watch.milliseconds(
                [&] { add<T, N, policy<>><<<blocks, threads>>>(static_cast<T*>(memory), d.how, d.among); });
            if (round < 0) continue;
            plain.push_back(a);
            matched.push_back(b);
        }
        std::ranges::sort(plain);
        std::ranges::sort(matched);
        const double a = plain[rounds / 2], b = matched[rounds / 2];
        std::printf("| %s | %d | %s | %.2f | %.2f | %.2f |\n", type, N, d.name, a, b, a / b);
        rows.push_back({{"type", type},
                        {"n", N},
                        {"keys", d.name},
                        {"ms_plain", a},
                        {"ms_matched", b},
                        {"ratio", a / b},
                        {"ratio_least", plain.front() / matched.back()},
                        {"ratio_most", plain.back() / matched.front()}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        nlohmann::ordered_json json = figures_of_this_gpu("match");
        json["seed"] = seed;
        json["warp_steps"] = std::uint64_t{blocks} * (threads / 32) * steps;
        json["rounds"] = rounds;
        void* memory = nullptr;
        check(cudaMalloc(&memory, sizeof(float) * 9 * keys));
        check(cudaMemset(memory, 0, sizeof(float) * 9 * keys));
        std::printf(
            "| type | N | keys of a warp | plain, ms | matched, ms | ratio |\n| --- | --- | --- | --- | --- "
            "| --- |\n");
        bench<unsigned, 1>("unsigned", memory, json["rows"]);
        bench<float, 1>("float", memory, json["rows"]);
        bench<float, 4>("float", memory, json["rows"]);
        bench<float, 9>("float", memory, json["rows"]);
        check(cudaFree(memory));
        if (argc > 1) std::ofstream(argv[1]) << json.dump(1) << '\n';
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
