// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Warps of 8, 16 and 64 SIMD lanes: what depends on their number. Arithmetic does not: see test_lanes.cpp.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

namespace {

using narrow = warpagg::emulator::narrow_lanes<8>;
using half = warpagg::emulator::narrow_lanes<16>;
using wide = warpagg::emulator::wide_lanes;

/// A value per lane that is equal to no other's, in either form of chunk.
template <class T, class W>
warpagg::value_t<W, T> numbered() {
    warpagg::value_t<W, T> v;
    for (unsigned i = 0; i < W::size; ++i) v.set(static_cast<int>(i), static_cast<T>(3 * i + 1));
    return v;
}
template <class T>
T number(unsigned lane) {
    return static_cast<T>(3 * lane + 1);
}

template <class W>
warpagg::mask_t<W> flags(std::uint64_t mask) {
    warpagg::mask_t<W> f(false);
    for (unsigned i = 0; i < W::size; ++i) f.set(static_cast<int>(i), ((mask >> i) & 1u) != 0);
    return f;
}

constexpr std::uint64_t some_masks[] = {0x0, 0x1, 0x80, 0xff, 0x5a, 0x8000, 0xffff, 0xa35c,
                                        // bits of lanes beyond 32, which narrow warps ignore
                                        0x100000000, 0x8000000000000000, 0xffffffff00000000,
                                        0xffffffffffffffff, 0x0123456789abcdef};

template <class T, class W>
void check_shuffles() {
    const W w;
    const auto v = numbered<T, W>();
    for (unsigned distance = 0; distance <= 64; ++distance) {
        INFO("distance ", distance);
        const auto one = w.shfl(v, distance), own = w.shfl(v, w.lane() + distance);
        const auto down = w.shfl_down(v, distance), across = w.shfl_xor(v, distance);
        for (unsigned i = 0; i < W::size; ++i) {
            const int lane = static_cast<int>(i);
            CHECK(one[lane] == number<T>(distance % W::size));
            CHECK(own[lane] == number<T>((i + distance) % W::size));
            CHECK(down[lane] == number<T>(i + distance < W::size ? i + distance : i));
            CHECK(across[lane] == number<T>((i ^ distance) % W::size));
        }
    }
}

/// Integers, which add up to the same in any order.
template <int N, class Policy, class W>
void check_sums() {
    const W w;
    for (const std::uint64_t mask : some_masks) {
        warpagg::value_t<W, std::int32_t> v[N];
        std::vector<std::int32_t> memory(N + 2, -5), expected = memory;
        for (int n = 0; n < N; ++n) {
            v[n] = numbered<std::int32_t, W>() * (1 << n % 16);
            for (unsigned i = 0; i < W::size; ++i)
                if (((mask >> i) & 1u) != 0)
                    expected[static_cast<std::size_t>(n) + 1] += number<std::int32_t>(i) * (1 << n % 16);
        }
        warpagg::warp_reduce_atomic(w, memory.data() + 1, v, flags<W>(mask), Policy{});
        INFO("N ", N, ", mask ", mask);
        CHECK(memory == expected);
    }
}

}  // namespace

TEST_SUITE_BEGIN("warp sizes");

TEST_CASE_TEMPLATE("shuffles, at every distance and past the end", W, narrow, half, wide) {
    check_shuffles<float, W>();
    check_shuffles<double, W>();
}

TEST_CASE_TEMPLATE("votes", W, narrow, half, wide) {
    const W w;
    for (const std::uint64_t mask : some_masks) {
        const std::uint64_t own = mask & (~std::uint64_t{0} >> (64 - W::size));
        CHECK(w.ballot(flags<W>(mask)) == own);
        CHECK(w.any(flags<W>(mask)) == (own != 0));
    }
    const auto equal = w.match(w.lane() % 3u);
    for (int i = 0; i < static_cast<int>(W::size); ++i)
        for (int k = 0; k < static_cast<int>(W::size); ++k)
            CHECK(((equal[i] >> k) & 1u) == (i % 3 == k % 3 ? 1u : 0u));
}

TEST_CASE_TEMPLATE("bits of lanes: the lowest one, and their number", W, narrow, half, wide) {
    const W w;
    const auto equal = w.match(w.lane() / 40u);
    const auto first = countr_zero(equal), count = popcount(equal);
    for (unsigned i = 0; i < W::size; ++i) {
        const int lane = static_cast<int>(i);
        CHECK(first[lane] == i / 40 * 40);
        CHECK(count[lane] == (i < 40 ? std::min(W::size, 40u) : W::size - 40));
    }
}

TEST_CASE_TEMPLATE("memory", W, narrow, half, wide) {
    const W w;
    for (const std::uint64_t mask : some_masks) {
        const auto active = flags<W>(mask);
        std::vector<float> row(W::size), scattered(2 * W::size), expected = scattered;
        w.store_row(row.data(), 0, numbered<float, W>(), active);
        w.store(scattered.data(), w.lane() * 2u, numbered<float, W>(), active);
        const auto from_row = w.load_row(row.data(), 0, active);
        const auto from_scattered = w.load(scattered.data(), w.lane() * 2u, active);
        for (unsigned i = 0; i < W::size; ++i) {
            const float own = ((mask >> i) & 1u) != 0 ? number<float>(i) : 0.0f;
            CHECK(row[i] == own);
            expected[2 * i] = own;
            CHECK(from_row[static_cast<int>(i)] == own);
            CHECK(from_scattered[static_cast<int>(i)] == own);
        }
        CHECK(scattered == expected);

        std::vector<float> records(4 * W::size, -1);
        const warpagg::value_t<W, float> four[4] = {numbered<float, W>(), 2.0f, 3.0f, numbered<float, W>()};
        w.store_packed(records.data(), w.lane() * 4u, four, active);
        warpagg::value_t<W, float> back[4];
        w.load_packed(records.data(), w.lane() * 4u, back, active);
        for (unsigned i = 0; i < W::size; ++i)
            for (unsigned k = 0; k < 4; ++k) {
                const bool there = ((mask >> i) & 1u) != 0;
                const int lane = static_cast<int>(i);
                CHECK(records[4 * i + k] == (there ? four[k][lane] : -1.0f));
                CHECK(back[k][lane] == (there ? four[k][lane] : 0.0f));
            }
    }
}

TEST_CASE_TEMPLATE("sums of more and of fewer values than lanes", W, narrow, half, wide) {
    using warpagg::policy;
    namespace reduce = warpagg::reduce;
    check_sums<1, policy<reduce::scatter>, W>();
    check_sums<9, policy<reduce::scatter>, W>();
    check_sums<16, policy<reduce::scatter>, W>();
    check_sums<static_cast<int>(W::size) + 1, policy<reduce::scatter>, W>();
    check_sums<9, policy<reduce::butterfly, warpagg::commit::contiguous>, W>();
    check_sums<9, policy<reduce::shfl_down>, W>();
}

TEST_SUITE_END();
