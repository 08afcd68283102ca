// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What lanes do wrong together.

#include <warpagg/iterations.hpp>

#include "../support/diagnoses.hpp"

TEST_SUITE_BEGIN("checked");

TEST_CASE("a lane missing from its own mask") {
    unsigned line = 0;
    is_diagnosed({diagnosis::lane_not_in_mask, 1u << 31, "any_sync", &line}, {},
                 [&](const checked& w) { line = __LINE__, w.any_sync(lanes(0, 30), true); });
    is_clean({}, [](const checked& w) { w.any_sync(everyone, true); });
    is_clean({}, [](const checked& w) {
        if (w.lane() < 31) w.any_sync(lanes(0, 30), true);
    });
}

TEST_CASE("a collective that lanes do not reach, as they have returned") {
    unsigned line = 0;
    is_diagnosed({diagnosis::collective_not_reached, lanes(20, 31), "ballot", &line}, {},
                 [&](const checked& w) {
                     if (w.lane() >= 20) return;
                     line = __LINE__, w.ballot(true);
                 });
    CHECK(try_launch({},
                     [](const checked& w) {
                         if (w.lane() < 20) w.ballot(true);
                     })
              .sentence ==
          "Lanes 0-19 wait for lanes 20-31 in ballot, but lanes 20-31 returned. A likely cause is "
          "a continue, break or return before the call.");
    is_clean({}, [](const checked& w) {
        w.ballot(w.lane() < 20);
        if (w.lane() >= 20) return;
    });
    // CUDA's masked operations do not miss lanes that have returned.
    is_clean({}, [](const checked& w) {
        if (w.lane() < 20) w.ballot_sync(everyone, true);
    });
}

TEST_CASE("loops of different lengths") {
    unsigned line = 0;
    is_diagnosed({diagnosis::collective_not_reached, lanes(8, 31), "shfl_xor", &line}, {},
                 [&](const checked& w) {
                     for (unsigned i = w.lane(); i < 40; i += 32) line = __LINE__, w.shfl_xor(i, 1);
                 });
    is_clean({}, [](const checked& w) {
        for (unsigned i = w.lane(); i - w.lane() < 40; i += 32) w.shfl_xor(i < 40 ? i : 0, 1);
    });
}

TEST_CASE("a call of the library that lanes do not reach") {
    float sums[9] = {};
    const float v[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    unsigned line = 0;
    is_diagnosed({diagnosis::collective_not_reached, everyone & ~(1u << 7), "warp_reduce_atomic", &line}, {},
                 [&](const checked& w) {
                     const bool active = w.lane() == 7;
                     if (active) line = __LINE__, warpagg::warp_reduce_atomic(w, sums, v, active);
                 });
    is_diagnosed({diagnosis::collective_not_reached, lanes(16, 31), "skip_if_warp_idle", &line}, {},
                 [&](const checked& w) {
                     if (w.lane() < 16) line = __LINE__, warpagg::skip_if_warp_idle(w, true);
                 });
    is_clean({}, [&](const checked& w) {
        const bool active = w.lane() == 7;
        if (warpagg::skip_if_warp_idle(w, active)) return;
        warpagg::warp_reduce_atomic(w, sums, v, active);
    });
}

TEST_CASE("lanes at different call sites") {
    unsigned low = 0, high = 0;
    is_diagnosed({diagnosis::different_call_sites, lanes(8, 31), "any", &low, &high}, {},
                 [&](const checked& w) {
                     if (w.lane() < 8) {
                         low = __LINE__, w.any(true);
                     } else {
                         high = __LINE__, w.any(false);
                     }
                 });
    is_clean({}, [](const checked& w) { w.any(w.lane() < 8); });
    is_clean({}, [](const checked& w) {  // each half for itself
        if (w.lane() < 8) {
            w.any_sync(lanes(0, 7), true);
        } else {
            w.any_sync(lanes(8, 31), false);
        }
    });
}

TEST_CASE("different operations at one line") {
    unsigned line = 0;
    is_diagnosed(
        {diagnosis::different_call_sites, lanes(8, 31), "any", &line, &line}, {},
        [&](const checked& w) { line = __LINE__, w.lane() < 8 ? w.any(true) : w.ballot(true) != 0; });
}

TEST_CASE("a library that two branches call") {
    const auto vote = [](const checked& w, unsigned& line, unsigned here) {
        line = here;
        return w.any(true);
    };
    unsigned low = 0, high = 0;
    unsigned sums[1] = {};
    const unsigned v[1] = {1};
    is_diagnosed({diagnosis::different_call_sites, lanes(8, 31), "warp_reduce_atomic", &low, &high}, {},
                 [&](const checked& w) {
                     if (w.lane() < 8) {
                         low = __LINE__, warpagg::warp_reduce_atomic(w, sums, v, true);
                     } else {
                         high = __LINE__, warpagg::warp_reduce_atomic(w, sums, v, true);
                     }
                 });
    // Nobody has told of `vote`, so it is one place.
    is_clean({}, [&](const checked& w) {
        if (w.lane() < 8) {
            vote(w, low, __LINE__);
        } else {
            vote(w, high, __LINE__);
        }
    });
}

TEST_CASE("different masks") {
    unsigned line = 0;
    is_diagnosed({diagnosis::different_masks, 1u << 16, "any_sync", &line}, {}, [&](const checked& w) {
        const std::uint32_t mask = w.lane() < 16 ? lanes(0, 16) : lanes(15, 31);
        line = __LINE__, w.any_sync(mask, true);
    });
    is_clean({}, [](const checked& w) {
        const std::uint32_t mask = w.lane() < 16 ? lanes(0, 15) : lanes(16, 31);
        w.any_sync(mask, true);
    });
}

TEST_CASE("lanes paired in different iterations") {
    constexpr std::uint32_t odd = 0xaaaaaaaau;
    unsigned line = 0;
    is_diagnosed({diagnosis::different_iterations, odd, "any", &line}, {}, [&](const checked& w) {
        for (const unsigned i : warpagg::iterations(w, 4)) {
            if (i == w.lane() % 2) continue;
            line = __LINE__, w.any(true);
        }
    });
    is_clean({}, [](const checked& w) {
        for (const unsigned i : warpagg::iterations(w, 4)) w.any(i != w.lane() % 2);
    });
    is_clean({}, [](const checked& w) {  // a mask of those that are in the iteration
        for (const unsigned i : warpagg::iterations(w, 4)) {
            const std::uint32_t there = w.ballot(i != w.lane() % 2);
            if (i == w.lane() % 2) continue;
            w.any_sync(there, true);
        }
    });
    is_clean({}, [](const checked& w) {  // the loop may end early, and other loops may be inside
        for (const unsigned i : warpagg::iterations(w, 40)) {
            for (const unsigned j : warpagg::iterations(w, w.lane() % 3))
                if (j == i) break;
            if (i == w.lane()) break;
        }
        w.any(true);
        for (const unsigned i : warpagg::iterations(w, 2)) w.any(i > 0);
    });
}

TEST_CASE("a destination that is not uniform") {
    float sums[2][3] = {};
    const float v[3] = {1, 2, 3};
    unsigned line = 0;
    is_diagnosed({diagnosis::destination_not_uniform, lanes(30, 31), "warp_reduce_atomic", &line}, {},
                 [&](const checked& w) {
                     float* const record = sums[w.lane() / 30];
                     line = __LINE__, warpagg::warp_reduce_atomic(w, record, v, true);
                 });
    is_clean({.threads = 64}, [&](const checked& w) {
        float* const record = sums[w.thread_index() / 32];
        warpagg::warp_reduce_atomic(w, record, v, true);
    });
}

TEST_CASE("a continue before a call of the library") {
    float sums[2] = {};
    const float v[1] = {1};
    unsigned line = 0;
    const auto kernel = [&](unsigned first) {
        return [&, first](const checked& w) {
            for (unsigned i = 0; i < 2; ++i) {
                if (w.lane() < first && i == 0) continue;
                line = __LINE__, warpagg::warp_reduce_atomic(w, sums + i, v, true);
            }
        };
    };
    is_diagnosed({diagnosis::destination_not_uniform, lanes(8, 31), "warp_reduce_atomic", &line}, {},
                 kernel(8));
    is_clean({}, kernel(0));
    CHECK(try_launch({}, kernel(8))
              .sentence.ends_with(". A likely cause is a continue or an early return before the call."));
}

TEST_CASE("assume_busy on an idle warp") {
    using warpagg::policy, warpagg::shfl_down, warpagg::assume_busy;
    float sums[3] = {};
    const float v[3] = {1, 2, 3};
    unsigned line = 0;
    is_diagnosed(
        {diagnosis::idle_warp, everyone, "warp_reduce_atomic", &line, nullptr, 1}, {.threads = 64},
        [&](const checked& w) {
            const bool active = w.thread_index() == 5;
            line = __LINE__, warpagg::warp_reduce_atomic(w, sums, v, active, policy{assume_busy, shfl_down});
        });
    is_clean({.threads = 64}, [&](const checked& w) {
        const bool active = w.thread_index() == 5;
        if (warpagg::skip_if_warp_idle(w, active)) return;
        warpagg::warp_reduce_atomic(w, sums, v, active, policy{assume_busy, shfl_down});
    });
}

TEST_CASE("a barrier that threads do not reach") {
    unsigned line = 0;
    is_diagnosed({diagnosis::barrier_not_reached, lanes(8, 31), "barrier", &line, nullptr, 1},
                 {.threads = 64}, [&](const checked& w) {
                     if (w.thread_index() >= 40) return;
                     line = __LINE__, w.barrier();
                 });
    is_clean({.threads = 64}, [](const checked& w) {
        w.barrier();
        if (w.thread_index() >= 40) return;
    });
}

TEST_CASE("a barrier in a branch") {
    unsigned line = 0;
    is_diagnosed({diagnosis::collective_not_reached, lanes(0, 3), "any", &line, nullptr, 1}, {.threads = 64},
                 [&](const checked& w) {
                     if (w.thread_index() >= 32 && w.lane() < 4) w.barrier();
                     line = __LINE__, w.any(true);
                     w.barrier();
                 });
    unsigned low = 0, high = 0;
    is_diagnosed({diagnosis::different_call_sites, lanes(0, 31), "barrier", &low, &high, 1}, {.threads = 64},
                 [&](const checked& w) {
                     if (w.thread_index() < 32) {
                         low = __LINE__, w.barrier();
                     } else {
                         high = __LINE__, w.barrier();
                     }
                 });
    is_clean({.threads = 64}, [](const checked& w) {
        w.any(true);
        w.barrier();
    });
}

TEST_SUITE_END();
