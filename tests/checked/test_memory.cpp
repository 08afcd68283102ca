// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Wrong uses of memory by lanes.

#include <algorithm>
#include <vector>
#include <warpagg/warp/fork_shadow_process.hpp>

#include "../support/diagnoses.hpp"

namespace {

using warpagg::operation::sum;

/// An accessor for `atomic`.
template <class T>
auto at(T* to) {
    return [to](unsigned i) { return to + i; };
}

constexpr std::uint32_t both = (1u << 4) | (1u << 9);

}  // namespace

TEST_SUITE_BEGIN("checked");

TEST_CASE("a race of two lanes") {
    unsigned writes = 0, reads = 0;
    std::vector<int> memory(32);
    const auto race = [&](const char* function, const auto& write, const auto& read) {
        const auto kernel = [&](bool with_sync) {
            return [&, with_sync](const checked& w) {
                if (w.lane() == 4) write(w);
                if (with_sync) w.sync();
                if (w.lane() == 9) read(w);
            };
        };
        is_diagnosed({diagnosis::data_race, both, function, &writes, &reads}, {}, kernel(false));
        is_clean({}, kernel(true));
    };
    SUBCASE("load and store") {
        race(
            "store", [&](const checked& w) { writes = __LINE__, w.store(memory.data(), 3, 1, true); },
            [&](const checked& w) { reads = __LINE__, w.load(memory.data(), 3, true); });
    }
    SUBCASE("rows") {
        race(
            "store_row", [&](const checked& w) { writes = __LINE__, w.store_row(memory.data(), 5, 1, true); },
            [&](const checked& w) { reads = __LINE__, w.load_row(memory.data(), 0, true); });
    }
    SUBCASE("whole rows") {
        race(
            "store_row", [&](const checked& w) { writes = __LINE__, w.store_row(memory.data(), 5, 1, true); },
            [&](const checked& w) { reads = __LINE__, w.load_row(memory.data(), 0); });
    }
    SUBCASE("a watched array") {
        watched<int> a(memory);
        int got = 0;
        race(
            "[]", [&](const checked&) { writes = __LINE__, a[3] = 1; },
            [&](const checked&) { reads = __LINE__, got = a[3]; });
        CHECK(got == 1);
    }
    SUBCASE("two writes") {
        race(
            "store", [&](const checked& w) { writes = __LINE__, w.store(memory.data(), 3, 1, true); },
            [&](const checked& w) { reads = __LINE__, w.store(memory.data(), 3, 1, true); });
    }
    SUBCASE("parts of a value") {
        auto* const bytes = reinterpret_cast<unsigned char*>(memory.data());
        race(
            "store", [&](const checked& w) { writes = __LINE__, w.store(memory.data(), 0, 1, true); },
            [&](const checked& w) { reads = __LINE__, w.load(bytes, 3, true); });
    }
}

TEST_CASE("what a sync orders, and what not") {
    unsigned writes = 0, reads = 0;
    int memory = 0;
    const auto kernel = [&](const auto& between) {
        return [&](const checked& w) {
            if (w.lane() == 4) writes = __LINE__, w.store(&memory, 0, 1, true);
            between(w);
            if (w.lane() == 9) reads = __LINE__, w.load(&memory, 0, true);
        };
    };
    const expected race{diagnosis::data_race, both, "store", &writes, &reads};
    SUBCASE("a vote and a shuffle order nothing") {
        is_diagnosed(race, {}, kernel([](const checked& w) { w.any(true), w.shfl(1, 4); }));
    }
    SUBCASE("a sync of other lanes orders nothing") {
        is_diagnosed(race, {}, kernel([](const checked& w) {
                         if (w.lane() < 9) w.sync(lanes(0, 8));
                     }));
    }
    SUBCASE("a sync before both orders nothing") {
        is_diagnosed(race, {}, [&](const checked& w) {
            w.sync();
            kernel([](const checked&) {})(w);
            w.sync();
        });
    }
    SUBCASE("a sync of the two does") {
        is_clean({}, kernel([](const checked& w) {
                     if ((both >> w.lane() & 1u) != 0) w.sync(both);
                 }));
    }
    SUBCASE("so does a chain of them") {
        is_clean({}, kernel([](const checked& w) {
                     if (w.lane() == 4 || w.lane() == 6) w.sync((1u << 4) | (1u << 6));
                     if (w.lane() == 6 || w.lane() == 9) w.sync((1u << 6) | (1u << 9));
                 }));
    }
    SUBCASE("and a barrier") {
        is_clean({}, kernel([](const checked& w) { w.barrier(); }));
    }
}

TEST_CASE("a race between warps") {
    unsigned writes = 0, reads = 0;
    const auto kernel = [&](bool with_barrier) {
        return [&, with_barrier](const checked& w) {
            const watched<int> a = w.shared<int>(64);
            a[w.thread_index()] = 1;
            w.sync();
            if (w.thread_index() == 4) writes = __LINE__, a[4] = 1;
            if (with_barrier) w.barrier();
            if (w.thread_index() == 36) reads = __LINE__, static_cast<void>(static_cast<int>(a[4]));
        };
    };
    for_each_seed(schedules, [&](std::uint64_t seed) {
        const report r = try_launch({.threads = 64, .seed = seed}, kernel(false));
        CHECK(r.what == diagnosis::data_race);
        CHECK((r.warp == 0 ? r.lanes == 1u << 4 : r.lanes == 1u << 4));  // thread 36 is lane 4 of warp 1
    });
    is_clean({.threads = 64}, kernel(true));
    is_clean({.blocks = 3, .threads = 64}, kernel(true));  // each block has an array of its own
}

TEST_CASE("a race between blocks") {
    int memory[2] = {};
    unsigned line = 0;
    is_diagnosed({diagnosis::data_race, 1u << 3, "store", &line, &line}, {.blocks = 2},
                 [&](const checked& w) {
                     if (w.lane() == 3) line = __LINE__, w.store(memory, 0, 1, true);
                 });
    is_clean({.blocks = 2}, [&](const checked& w) { w.store(memory, w.block_index(), 1, w.lane() == 3); });
}

TEST_CASE("accesses that are no race") {
    std::vector<unsigned char> bytes(64);
    std::vector<double> values(64);
    is_clean({}, [&](const checked& w) {
        w.store(bytes.data(), w.lane(), static_cast<unsigned char>(1), true);  // neighboring bytes
        w.load(bytes.data(), 40, true);                                        // all read
        w.store(values.data(), w.lane(), 1.0, true);
        w.store(values.data(), w.lane(), w.load(values.data(), w.lane(), true), true);  // its own
        double local[2] = {};
        w.store(local, 0, 1.0, true);  // on its stack
    });
    const watched<double> a(values);
    is_clean({}, [&](const checked& w) {
        a[w.lane()] = 1;
        a[w.lane()] += 2;
        a[w.lane()] -= 1;
        w.sync();
        a[w.lane() + 32] = a[31 - w.lane()];
    });
    CHECK(static_cast<double>(a[40]) == 2);
}

TEST_CASE("many reads before a write") {
    int memory[1] = {};
    for_each_seed(schedules, [&](std::uint64_t seed) {
        const report r = try_launch({.blocks = 4, .seed = seed}, [&](const checked& w) {
            for (int i = 0; i < 3; ++i) w.load(memory, 0, true);
            w.store(memory, 0, 1, w.block_index() == 2 && w.lane() == 0);
        });
        CHECK(r.what == diagnosis::data_race);
    });
}

TEST_CASE("atomic and plain accesses to one address") {
    unsigned memory[2] = {};
    unsigned plain = 0, atomic = 0;
    const auto kernel = [&](bool with_sync) {
        return [&, with_sync](const checked& w) {
            if (w.lane() == 4) plain = __LINE__, w.store(memory, 1, 0u, true);
            if (with_sync) w.sync();
            atomic = __LINE__, w.atomic(sum{}, at(memory), 1, 1u, w.lane() == 9);
        };
    };
    is_diagnosed({diagnosis::mixed_access, both, "store", &plain, &atomic}, {}, kernel(false));
    is_clean({}, kernel(true));

    is_diagnosed({diagnosis::mixed_access, both, "load", &plain, &atomic}, {}, [&](const checked& w) {
        if (w.lane() == 9) plain = __LINE__, w.load(memory, 1, true);
        atomic = __LINE__, w.atomic(sum{}, at(memory), 1, 1u, w.lane() == 4);
    });
    is_clean({}, [&](const checked& w) {
        w.atomic(sum{}, at(memory), 1, 1u, true);
        w.load(memory, 0, true);  // another address
    });
}

TEST_CASE("the library's commit and a plain read") {
    float sums[3] = {};
    const float v[3] = {1, 2, 3};
    constexpr warpagg::policy how{warpagg::shfl_down};  // lane 0 commits
    unsigned read = 0, commit = 0;
    const auto kernel = [&](bool with_barrier) {
        return [&, with_barrier](const checked& w) {
            commit = __LINE__, warpagg::warp_reduce_atomic(w, sums, v, true, how);
            if (with_barrier) w.barrier();
            if (w.lane() == 9) read = __LINE__, w.load(sums, 1, true);
        };
    };
    const std::uint32_t lanes = (1u << 9) | 1u;
    is_diagnosed({diagnosis::mixed_access, lanes, "warp_reduce_atomic", &commit, &read}, {}, kernel(false));
    is_clean({}, kernel(true));
}

TEST_CASE("what is read from an inactive lane must not reach memory") {
    unsigned read = 0, write = 0;
    float floats[32] = {};
    double doubles[32] = {};
    int ints[64] = {};
    const auto broken_and_twin = [&](const auto& kernel, const char* function = "store") {
        const std::uint32_t lane_5 = 1u << 5;
        is_diagnosed({diagnosis::inactive_lane_read, lane_5, function, &write, &read}, {},
                     [&](const checked& w) { kernel(w, 20u); });
        is_clean({}, [&](const checked& w) { kernel(w, 12u); });
    };
    /// Lane 5 reads lane `from` among lanes 0 to 15.
    const auto take = [&](const checked& w, auto value, unsigned from) {
        if (w.lane() >= 16) return value;
        return read = __LINE__, w.shfl_sync(lanes(0, 15), value, w.lane() == 5 ? from : w.lane());
    };
    SUBCASE("float") {
        broken_and_twin([&](const checked& w, unsigned from) {
            const float x = 2 * take(w, 1.0f, from) + 1;
            write = __LINE__, w.store(floats, w.lane(), x, true);
        });
    }
    SUBCASE("float, then double") {
        broken_and_twin([&](const checked& w, unsigned from) {
            const double x = 2.0 * take(w, 1.0f, from);
            write = __LINE__, w.store(doubles, w.lane(), x, true);
        });
    }
    SUBCASE("double") {
        broken_and_twin(
            [&](const checked& w, unsigned from) {
                const double x = take(w, 1.0, from);
                write = __LINE__, w.store_row(doubles, 0, x, true);
            },
            "store_row");
    }
    SUBCASE("float, compared") {
        broken_and_twin([&](const checked& w, unsigned from) {
            const int x = take(w, -1.0f, from) > 0 ? 1 : 2;
            write = __LINE__, w.store(ints, w.lane(), x, true);
        });
    }
    SUBCASE("float, committed by another lane") {
        broken_and_twin(
            [&](const checked& w, unsigned from) {
                const float v[1] = {take(w, 1.0f, from)};
                write = __LINE__, warpagg::warp_reduce_atomic(w, floats, v, w.lane() < 8);
            },
            "warp_reduce_atomic");
    }
    SUBCASE("int") {
        broken_and_twin([&](const checked& w, unsigned from) {
            const int x = take(w, 1, from) / 3;
            write = __LINE__, w.store(ints, w.lane(), x, true);
        });
    }
    SUBCASE("int, to a watched array") {
        const watched<int> a(ints);
        broken_and_twin(
            [&](const checked& w, unsigned from) {
                const int x = take(w, 1, from);
                write = __LINE__, a[w.lane()] = x;
            },
            "[]");
    }
    SUBCASE("int, which decides where to write") {
        broken_and_twin([&](const checked& w, unsigned from) {
            const unsigned column = take(w, 1, from) >= 0 ? 0 : 1;
            write = __LINE__, w.store(ints, w.lane() + 32 * column, 1, true);
        });
    }
}

TEST_CASE("which lanes are inactive") {
    float sum = 0;
    const auto sum_of_first = [&](unsigned n) {
        return [&, n](const checked& w) {
            float x = 1;
            if (w.lane() >= n) return;
            for (unsigned d = 16; d > 0; d /= 2) x += w.shfl_down_sync(lanes(0, n - 1), x, d);
            w.store(&sum, 0, x, w.lane() == 0);
        };
    };
    for (const unsigned n : {17u, 20u, 31u})
        for_each_seed(schedules, [&](std::uint64_t seed) {
            CHECK(try_launch({.seed = seed}, sum_of_first(n)).what == diagnosis::inactive_lane_read);
        });
    // All lanes; and with garbage in lanes whose sums are not used.
    is_clean({}, sum_of_first(32));
    is_clean({}, [&](const checked& w) {
        float x = 1;
        if (w.lane() >= 16) return;
        for (unsigned d = 8; d > 0; d /= 2) x += w.shfl_down_sync(lanes(0, 15), x, d);
        w.store(&sum, 0, x, w.lane() == 0);
    });
    CHECK(sum == 16);
    // A lane that has returned takes no part, even if the mask contains it.
    for_each_seed(schedules, [&](std::uint64_t seed) {
        const report r = try_launch({.seed = seed}, [&](const checked& w) {
            if (w.lane() == 9) return;
            w.store(&sum, 0, w.shfl_sync(everyone, 1.0f, 9), w.lane() == 0);
        });
        CHECK(r.what == diagnosis::inactive_lane_read);
        CHECK(r.lanes == 1u);
    });
}

TEST_CASE("what is read from an inactive lane and passed by is no misuse") {
    int ints[32] = {};
    is_clean({}, [&](const checked& w) {
        if (w.lane() >= 16) return;
        const int x = w.shfl_down_sync(lanes(0, 15), static_cast<int>(w.lane()), 1);
        w.store(ints, w.lane(), w.lane() < 15 ? x : -1, true);
    });
    CHECK(std::count(ints, ints + 32, 0) == 16);
}

TEST_SUITE_END();
