// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Warps on many threads add to the same memory: nothing is lost, and under ThreadSanitizer nothing races.

#include <doctest/doctest.h>

#include <cstdint>
#include <thread>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/checked.hpp>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

namespace {

constexpr unsigned threads = 4, steps = 200;

template <class F>
void on_each_thread(F f) {
    std::vector<std::thread> all;
    for (unsigned t = 0; t < threads; ++t) all.emplace_back([&f, t] { f(t); });
    for (std::thread& t : all) t.join();
}

/// What all warps add to: sums, extremes, bits, and one counter per key.
struct totals {
    float sum[3] = {};
    std::int64_t wide[2] = {};
    std::int32_t largest[1] = {};
    std::uint32_t bits[1] = {};
    unsigned histogram[5] = {};
};

template <class W>
void add_one_step(const W& w, totals& to, unsigned step) {
    using warpagg::convert;
    using warpagg::math::convert;
    const auto index = w.lane() + step * W::size;
    const auto active = (index & 1u) == 0u;
    const warpagg::value_t<W, float> ones[3] = {1.0f, 2.0f, 3.0f};
    const warpagg::value_t<W, std::int64_t> wide[2] = {std::int64_t{1} << 33, -1};
    const warpagg::value_t<W, std::int32_t> number[1] = {convert<std::int32_t>(index)};
    const warpagg::value_t<W, std::uint32_t> bit[1] = {warpagg::value_t<W, unsigned>(1u) << (index & 31u)};
    const warpagg::value_t<W, unsigned> one[1] = {1u};
    warpagg::warp_reduce_atomic(w, to.sum, ones, active);
    warpagg::warp_reduce_atomic(w, to.wide, wide, active, warpagg::policy{warpagg::per_lane});
    warpagg::warp_reduce_atomic(w, to.largest, number, active, warpagg::policy{warpagg::maximum});
    warpagg::warp_reduce_atomic(w, to.bits, bit, active, warpagg::policy{warpagg::bit_or, warpagg::per_lane});
    warpagg::warp_match_reduce_atomic(w, to.histogram, index - (index / 5u) * 5u, one, active);
}

/// Exact: all sums are whole and small.
template <class W>
void check_totals(const totals& t) {
    const unsigned indices = W::size * steps;
    const unsigned added = threads * indices / 2;
    for (unsigned i = 0; i < 3; ++i) CHECK(t.sum[i] == static_cast<float>((i + 1) * added));
    CHECK(t.wide[0] == static_cast<std::int64_t>(added) << 33);
    CHECK(t.wide[1] == -static_cast<std::int64_t>(added));
    CHECK(t.largest[0] == static_cast<std::int32_t>(indices - 2));
    CHECK(t.bits[0] == 0x55555555u);
    for (unsigned i = 0; i < 5; ++i) CHECK(t.histogram[i] == added / 5);
}

}  // namespace

TEST_SUITE_BEGIN("threads");

TEST_CASE_TEMPLATE("warps on many threads add to the same memory", W, warpagg::emulator::lanes,
                   warpagg::emulator::serial) {
    totals t;
    on_each_thread([&t](unsigned) {
        for (unsigned step = 0; step < steps; ++step) add_one_step(W{}, t, step);
    });
    check_totals<W>(t);
}

TEST_CASE("each thread launches a simulator of its own") {
    std::vector<totals> of_thread(threads);
    on_each_thread([&of_thread](unsigned thread) {
        const auto report = warpagg::emulator::try_launch({}, [&](const warpagg::emulator::checked& w) {
            for (unsigned step = 0; step < steps; ++step) add_one_step(w, of_thread[thread], step);
        });
        if (!report.ok()) of_thread[thread].sum[0] = -1;
    });
    for (const totals& t : of_thread) {
        CHECK(t.sum[2] == 3.0f * 16 * steps);
        CHECK(t.bits[0] == 0x55555555u);
    }
}

TEST_SUITE_END();

namespace {

template <class Accumulate>
void check_cells(const char* name) {
    constexpr unsigned rounds = 2000;
    warpagg::accumulator<Accumulate> sums[2];
    on_each_thread([&](unsigned thread) {
        const warpagg::emulator::narrow_lanes<8> w;
        for (unsigned i = 0; i < rounds; ++i) {
            const float x = thread % 2 == 0 ? 1024.0f : 0.125f;
            const warpagg::simd_value<float, 8> values[2] = {x, -x};
            warpagg::warp_reduce_atomic(w, sums, values, w.lane() < 4u, warpagg::policy{Accumulate{}});
        }
    });
    INFO(name);
    const float sum = 4 * rounds * threads / 2 * (1024.0f + 0.125f);
    CHECK(sums[0].value() == sum);
    CHECK(sums[1].value() == -sum);
}

}  // namespace

TEST_CASE("threads add to accumulators of every kind") {
    check_cells<warpagg::accumulate::f64>("f64");
    check_cells<warpagg::accumulate::compensated>("compensated");
    check_cells<warpagg::accumulate::fixed<10>>("fixed<10>");
    check_cells<warpagg::accumulate::binned<2>>("binned<2>");
    check_cells<warpagg::accumulate::exact>("exact");
}
