// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The checked model with 64 lanes: what depends on lanes from 32 on.

#include <doctest/doctest.h>

#include <vector>

#include "../support/diagnoses.hpp"

namespace {

using warpagg::emulator::wide_checked;

constexpr grid one_warp{.threads = 64}, two_warps{.threads = 128};
constexpr std::uint64_t upper_half = 0xffffffff00000000u;
unsigned line;

}  // namespace

TEST_SUITE_BEGIN("wide warps");

TEST_CASE("collectives reach all 64 lanes") {
    std::vector<std::uint64_t> odd(128), equal(128), asked(128);
    std::vector<unsigned> reversed(128);
    is_clean<wide_checked>(two_warps, [&](const wide_checked& w) {
        const unsigned t = w.thread_index();
        odd[t] = w.ballot(w.lane() % 2 == 1);
        equal[t] = w.match(w.lane() / 32);
        reversed[t] = w.shfl(w.lane(), 63 - w.lane());
        if (w.lane() >= 32) asked[t] = w.ballot_sync(upper_half, w.lane() == 63);
    });
    for (unsigned t = 0; t < 128; ++t) {
        CAPTURE(t);
        const unsigned lane = t % 64;
        CHECK(odd[t] == 0xaaaaaaaaaaaaaaaau);
        CHECK(equal[t] == (lane < 32 ? ~upper_half : upper_half));
        CHECK(reversed[t] == 63 - lane);
        CHECK(asked[t] == (lane < 32 ? 0 : std::uint64_t{1} << 63));
    }
}

TEST_CASE("a lane that returns early") {
    is_diagnosed<wide_checked>({diagnosis::collective_not_reached, std::uint64_t{1} << 40, "any", &line},
                               one_warp, [](const wide_checked& w) {
                                   if (w.lane() == 40) return;
                                   line = __LINE__ + 1;
                                   w.any(true);
                               });
}

TEST_CASE("a lane that is not in its mask") {
    is_diagnosed<wide_checked>({diagnosis::lane_not_in_mask, std::uint64_t{1} << 63, "ballot_sync", &line},
                               one_warp, [](const wide_checked& w) {
                                   line = __LINE__ + 1;
                                   if (w.lane() == 63) w.ballot_sync(1, true);
                               });
}

TEST_CASE("lanes of the upper half with another destination") {
    float memory[2] = {};
    is_diagnosed<wide_checked>({diagnosis::destination_not_uniform, upper_half, "warp_reduce_atomic", &line},
                               one_warp, [&](const wide_checked& w) {
                                   const float values[1] = {1};
                                   line = __LINE__ + 1;
                                   warpagg::warp_reduce_atomic(w, memory + w.lane() / 32, values, true);
                               });
}

TEST_CASE("a race between the halves of a warp, which a sync resolves") {
    std::vector<int> memory(64);
    const auto exchange = [&](bool synchronize) {
        return [&memory, synchronize](const wide_checked& w) {
            w.store_row(memory.data(), 0, 1, true);
            if (synchronize) w.sync();
            w.load(memory.data(), w.lane() ^ 32u, true);
        };
    };
    is_clean<wide_checked>(one_warp, exchange(true));
    for_each_seed(schedules, [&](std::uint64_t seed) {
        const report r = try_launch<wide_checked>({.threads = 64, .seed = seed}, exchange(false));
        CHECK(std::string(name(r.what)) == "data_race");
    });
}

TEST_CASE("a report lists 64 lanes") {
    const report r = try_launch<wide_checked>(one_warp, [](const wide_checked& w) {
        if (w.lane() > 60 || w.lane() == 3) return;
        w.sync();
    });
    CHECK(r.text().find("lanes 3, 61-63 (0xe000000000000008) of warp 0 of block 0") != std::string::npos);
}

TEST_SUITE_END();
