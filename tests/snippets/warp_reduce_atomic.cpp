// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

namespace {

using warpagg::simd_value;
using warpagg::emulator::counted_lanes;
using warpagg::emulator::counters;

}  // namespace

//! [a type of yours]
struct gradient {
    float mean[2], opacity;
};
template <>
struct warpagg::aggregate_traits<gradient> : warpagg::aggregate_of<float, 3> {};

template <warpagg::warp W>
void add(const W& w, gradient* gradients, unsigned id, const gradient& mine, bool active) {
    warpagg::warp_reduce_atomic(w, gradients + id, mine, active);
}
//! [a type of yours]

TEST_CASE("warp_reduce_atomic") {
    counters did;
    const counted_lanes w{{&did}};
    //! [warp_reduce_atomic]
    const simd_value<float, 32> x = warpagg::convert<float>(w.lane());  // 0 to 31
    const simd_value<float, 32> values[2] = {x, x * x};
    float record[2] = {1000, 2000};
    warpagg::warp_reduce_atomic(w, record, values, x < 10.0f);
    // record: 1045, 2285, by one atomic instruction
    //! [warp_reduce_atomic]
    CHECK(record[0] == 1045);
    CHECK(record[1] == 2285);
    CHECK(did.commits == 1);
}

TEST_CASE("warp_reduce_atomic with a policy") {
    counters did;
    const counted_lanes w{{&did}};
    const auto x = warpagg::convert<float>(w.lane());
    const simd_value<float, 32> values[9] = {x, x, x, x, x, x, x, x, x};
    float record[9] = {};
    //! [policy]
    using namespace warpagg;
    warp_reduce_atomic(w, record, values, x < 10.0f, policy{shfl_down, scalar});
    // 45 shuffles, 9 atomics in 9 commits, one vote: the method of the paper
    //! [policy]
    CHECK(record[8] == 45);
    CHECK(did.shuffles == 45);
    CHECK(did.atomics == 9);
    CHECK(did.commits == 9);
    CHECK(did.votes == 1);
}

TEST_CASE("warp_reduce_atomic with another operation") {
    const warpagg::emulator::lanes w;
    //! [operation]
    const simd_value<unsigned, 32> lane = w.lane();
    const simd_value<unsigned, 32> values[1] = {lane};
    unsigned least = 100, most = 3;
    warpagg::warp_reduce_atomic(w, &least, values, lane > 6u, warpagg::policy{warpagg::minimum});
    warpagg::warp_reduce_atomic(w, &most, values, lane > 6u, warpagg::policy{warpagg::maximum});
    // least: 7, most: 31
    //! [operation]
    CHECK(least == 7);
    CHECK(most == 31);
}

TEST_CASE("warp_reduce_atomic into several arrays") {
    const warpagg::emulator::lanes w;
    const simd_value<float, 32> values[5] = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f};
    //! [fields]
    float color[3 * 8] = {}, mean[2 * 8] = {};
    const unsigned id = 5;
    using warpagg::at;
    warpagg::warp_reduce_atomic(w, warpagg::fields(at<3>(color + 3 * id), at<2>(mean + 2 * id)), values,
                                w.lane() < 4u);
    // color[15..17]: 4, 8, 12; mean[10..11]: 16, 20
    //! [fields]
    for (unsigned i = 0; i < 3; ++i) CHECK(color[15 + i] == 4.0f * static_cast<float>(i + 1));
    CHECK(mean[10] == 16);
    CHECK(mean[11] == 20);
    CHECK(color[14] + color[18] + mean[9] + mean[12] == 0);
}

TEST_CASE("warp_reduce_atomic to addresses that a function computes") {
    const warpagg::emulator::lanes w;
    const simd_value<float, 32> values[3] = {1.0f, 2.0f, 3.0f};
    //! [accessor]
    float planes[3][8] = {};  // component i of record 5 lies in plane i
    warpagg::warp_reduce_atomic(
        w, [&](unsigned i) { return planes[i] + 5; }, values, w.lane() < 4u);
    // planes[0][5]: 4, planes[1][5]: 8, planes[2][5]: 12
    //! [accessor]
    for (unsigned i = 0; i < 3; ++i) CHECK(planes[i][5] == 4.0f * static_cast<float>(i + 1));
    CHECK(planes[0][4] + planes[1][6] == 0);
}

TEST_CASE("warp_reduce_atomic of a type of yours") {
    gradient sums[2] = {};
    for (const float x : {1.0f, 2.0f, 3.0f})
        add(warpagg::emulator::serial{}, sums, 1, gradient{{x, 10 * x}, 100 * x}, x != 2.0f);
    CHECK(sums[1].mean[0] == 4);
    CHECK(sums[1].mean[1] == 40);
    CHECK(sums[1].opacity == 400);
    CHECK(sums[0].opacity == 0);
}

TEST_CASE("skip_if_warp_idle") {
    counters did;
    const counted_lanes w{{&did}};
    float sum = 0;
    //! [skip_if_warp_idle]
    for (unsigned first = 0; first < 128; first += 32) {
        const simd_value<unsigned, 32> i = w.lane() + first;
        const auto active = i < 40u;
        if (warpagg::skip_if_warp_idle(w, active)) continue;  // from i = 64 on
        const simd_value<float, 32> values[1] = {warpagg::convert<float>(i)};
        warpagg::warp_reduce_atomic(w, &sum, values, active,
                                    warpagg::policy{warpagg::assume_busy, warpagg::scatter});
    }
    // sum: 780 = 0 + 1 + ... + 39, by 2 atomics and 4 votes
    //! [skip_if_warp_idle]
    CHECK(sum == 780);
    CHECK(did.atomics == 2);
    CHECK(did.votes == 4);
}
