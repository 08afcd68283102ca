// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What the emulator costs beside a loop that somebody wrote with AVX2 intrinsics for one purpose: nine
/// floats a lane, of 32 or of 8 lanes, summed over a warp's active lanes and added to a record by nine
/// atomics. Both make the same sums, to the bit. They take turns, so that both see the same state of the
/// machine.

#include <immintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

#if !defined(__AVX2__)
#error "to be compiled for AVX2 at least"
#endif

namespace {

constexpr int values = 9;
constexpr std::size_t warps = 1024, records = 256;

/// The values of all warps of `size` lanes, and their destinations.
template <std::size_t size>
struct problem {
    std::vector<float> held = std::vector<float>(warps * values * size);  // [warp][value][lane]
    std::vector<std::uint32_t> active = std::vector<std::uint32_t>(warps * size);
    std::vector<std::uint32_t> record = std::vector<std::uint32_t>(warps);

    problem() {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> draw(-1, 1);
        for (float& x : held) x = draw(random);
        for (auto& a : active) a = random() % 4 == 0 ? 0 : 0xffffffffu;
        for (auto& r : record) r = static_cast<std::uint32_t>(random() % records);
    }
};

template <std::size_t size>
void by_emulator(const problem<size>& p, float* sums) {
    const warpagg::emulator::narrow_lanes<size> w;
    for (std::size_t i = 0; i < warps; ++i) {
        warpagg::simd_value<float, size> v[values];
        for (std::size_t k = 0; k < values; ++k)
            v[k] = w.load_row(p.held.data(), static_cast<std::ptrdiff_t>((i * values + k) * size));
        const auto active = w.load_row(p.active.data(), static_cast<std::ptrdiff_t>(i * size)) != 0u;
        // The default of nine values commits the values of fewer than eight lanes without reducing them.
        warpagg::warp_reduce_atomic(w, sums + p.record[i] * values, v, active,
                                    warpagg::policy<warpagg::gate::always>{});
    }
}

/// [a0 + a4 ... a3 + a7, b0 + b4 ... b3 + b7], and so on: eight vectors of eight become one of their sums.
/// @{
__m256 by_4(__m256 a, __m256 b) {
    return _mm256_add_ps(_mm256_permute2f128_ps(a, b, 0x20), _mm256_permute2f128_ps(a, b, 0x31));
}
__m256 by_2(__m256 a, __m256 b) {
    const __m256d x = _mm256_castps_pd(a), y = _mm256_castps_pd(b);
    return _mm256_add_ps(_mm256_castpd_ps(_mm256_unpacklo_pd(x, y)),
                         _mm256_castpd_ps(_mm256_unpackhi_pd(x, y)));
}
__m256 by_1(__m256 a, __m256 b) {
    return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x88), _mm256_shuffle_ps(a, b, 0xdd));
}
/// @}

template <std::size_t size>
void by_hand(const problem<size>& p, float* sums) {
    for (std::size_t i = 0; i < warps; ++i) {
        constexpr std::size_t chunks = size / 8;
        __m256 mask[chunks], s[values];
        for (std::size_t c = 0; c < chunks; ++c)
            mask[c] = _mm256_loadu_ps(reinterpret_cast<const float*>(&p.active[i * size + 8 * c]));
        for (std::size_t k = 0; k < values; ++k) {
            __m256 v[chunks];
            for (std::size_t c = 0; c < chunks; ++c)
                v[c] = _mm256_and_ps(mask[c], _mm256_loadu_ps(&p.held[(i * values + k) * size + 8 * c]));
            if constexpr (chunks == 4) {
                s[k] = _mm256_add_ps(_mm256_add_ps(v[0], v[2]), _mm256_add_ps(v[1], v[3]));
            } else {
                s[k] = v[0];
            }
        }
        alignas(32) float sum[8];
        const __m256 ab = by_4(s[0], s[1]), cd = by_4(s[2], s[3]), ef = by_4(s[4], s[5]),
                     gh = by_4(s[6], s[7]);
        _mm256_store_ps(sum, by_1(by_2(ab, cd), by_2(ef, gh)));
        const __m256 i4 = by_4(s[8], s[8]), i2 = by_2(i4, i4);
        const float last = _mm256_cvtss_f32(by_1(i2, i2));
        constexpr int place[8] = {0, 4, 1, 5, 2, 6, 3, 7};  // a c e g, b d f h
        float* to = sums + p.record[i] * values;
        for (int k = 0; k < 8; ++k)
            std::atomic_ref<float>(to[k]).fetch_add(sum[place[k]], std::memory_order_relaxed);
        std::atomic_ref<float>(to[8]).fetch_add(last, std::memory_order_relaxed);
    }
}

template <class F>
double nanoseconds_a_warp(const F& f) {
    constexpr int times = 50;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < times; ++i) f();
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    return taken.count() / (times * warps);
}

/// Returns whether both made the same sums.
template <std::size_t size>
bool compare() {
    const problem<size> p;
    std::vector<float> emulated(records * values), written(records * values);
    by_emulator(p, emulated.data());
    by_hand(p, written.data());
    const bool same = std::memcmp(emulated.data(), written.data(), emulated.size() * sizeof(float)) == 0;

    double emulator = 1e30, hand = 1e30;  // the fastest round, which other work disturbs least
    for (int round = 0; round < 200; ++round) {
        emulator = std::min(emulator, nanoseconds_a_warp([&] { by_emulator(p, emulated.data()); }));
        hand = std::min(hand, nanoseconds_a_warp([&] { by_hand(p, written.data()); }));
    }
    std::printf("| %zu | %.1f | %.1f | %.2f | %s |\n", size, emulator, hand, emulator / hand,
                same ? "yes" : "no");
    return same;
}

}  // namespace

int main() {
    std::printf("| lanes | emulator, ns per warp | by hand, ns per warp | ratio | same bits |\n");
    std::printf("| --- | --- | --- | --- | --- |\n");
    const bool same[] = {compare<32>(), compare<8>()};
    return same[0] && same[1] ? 0 : 1;
}
