// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Seeds, schedules, commit orders, counts, and how a launch ends.

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/iterations.hpp>
#include <warpagg/warp/checked.hpp>
#include <warpagg/warp/simd.hpp>

#include "../support/for_each_seed.hpp"

namespace {

namespace emulator = warpagg::emulator;
using emulator::checked;
using emulator::diagnosis;
using emulator::try_launch;
using warpagg::policy;
namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace gate = warpagg::gate;

/// In which order threads pass two votes and a load.
std::vector<unsigned> order_of(emulator::grid g) {
    std::vector<unsigned> order;
    const int zero = 0;
    const auto r = try_launch(g, [&](const checked& w) {
        order.push_back(w.thread_index());
        w.any(true);
        order.push_back(w.thread_index());
        w.load(&zero, 0, true);
        order.push_back(w.thread_index());
        w.any(true);
        order.push_back(w.block_index());
    });
    CHECK(r.text() == "");
    return order;
}

/// An operation that keeps the value that was committed last.
struct last {
    template <class T>
    static T combine(T, T b) {
        return b;
    }
};
using winners = std::array<unsigned, 8>;
winners last_commits(std::uint64_t seed) {
    winners memory{};
    const auto r = try_launch({.threads = 64, .seed = seed}, [&](const checked& w) {
        for (unsigned i = 0; i < memory.size(); ++i)
            w.atomic(
                last{}, [&](unsigned k) { return &memory[k]; }, i, w.thread_index(), true);
    });
    CHECK(r.text() == "");
    return memory;
}

/// What `f` writes to stderr, in a process of its own, and how that ends.
struct outcome {
    std::string text;
    int status;
};
template <class F>
outcome in_another_process(F f) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        emulator::detail::sanitizers::forked() = true;
        for (const int caught_by_doctest : {SIGABRT, SIGSEGV}) std::signal(caught_by_doctest, SIG_DFL);
        dup2(ends[1], STDERR_FILENO);
        f();
        _exit(0);
    }
    close(ends[1]);
    outcome o{};
    char buffer[4096];
    for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
        o.text.append(buffer, static_cast<std::size_t>(n));
    close(ends[0]);
    waitpid(child, &o.status, 0);
    return o;
}

/// Sets WARPAGG_SEED for a while.
struct environment {
    std::string before;
    explicit environment(const char* seed) {
        if (const char* old = std::getenv("WARPAGG_SEED")) before = old;
        setenv("WARPAGG_SEED", seed, 1);
    }
    ~environment() { before.empty() ? unsetenv("WARPAGG_SEED") : setenv("WARPAGG_SEED", before.c_str(), 1); }
};

void breaks_a_rule(const checked& w) {
    if (w.lane() != 3) w.any(true);
}

/// Needs 1 KiB of stack for each level.
unsigned descend(unsigned levels) {
    volatile char block[1024] = {};
    block[levels % 1024] = 1;
    return levels == 0 ? 0 : descend(levels - 1) + static_cast<unsigned>(block[levels % 1024]);
}

}  // namespace

TEST_SUITE_BEGIN("checked");

TEST_CASE("a seed fixes the schedule, and another makes another") {
    std::set<std::vector<unsigned>> orders;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const auto order = order_of({.blocks = 3, .threads = 64, .seed = seed});
        CHECK(order == order_of({.blocks = 3, .threads = 64, .seed = seed}));
        orders.insert(order);
    }
    CHECK(orders.size() == 50);
}

TEST_CASE("warps of a block take turns, and no lane is always first") {
    std::set<unsigned> first, first_block;
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        const auto order = order_of({.blocks = 2, .threads = 64, .seed = seed});
        first.insert(order.front());
        first_block.insert(order.back());
        const auto beginning =
            std::count_if(order.begin(), order.begin() + 64, [](unsigned t) { return t < 32; });
        CHECK(beginning > 0);
        CHECK(beginning < 64);
    }
    CHECK(first.size() == 64);
    CHECK(first_block.size() == 2);
}

TEST_CASE("commit orders come from the seed, for each element by itself") {
    std::set<winners> all;
    unsigned elements_differ = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const winners w = last_commits(seed);
        CHECK(w == last_commits(seed));
        elements_differ += std::set<unsigned>(w.begin(), w.end()).size() > 4 ? 1 : 0;
        all.insert(w);
    }
    CHECK(all.size() == 50);
    CHECK(elements_differ == 50);
}

TEST_CASE("the sum of floats in all orders") {
    std::set<float> sums;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        float total = 0;
        const auto r = try_launch({.threads = 128, .seed = seed}, [&](const checked& w) {
            constexpr float of_warp[] = {1e8f, -1e8f, 3, 3};
            warpagg::warp_reduce_atomic(w, &total, {of_warp[w.thread_index() / 32]}, w.lane() == 0);
        });
        CHECK(r.text() == "");
        sums.insert(total);
    }
    CHECK(sums == std::set<float>{0, 3, 6, 8});  // ulp(1e8) is 8
}

TEST_CASE("WARPAGG_SEED replays") {
    unsigned calls = 0;
    {
        const environment set("77");
        CHECK(try_launch({}, [](const checked&) {}).seed == 77);
        CHECK(try_launch({.seed = 5}, [](const checked&) {}).seed == 5);
        CHECK(order_of({}) == order_of({.seed = 77}));
        CHECK(emulator::for_each_seed(200, [&](std::uint64_t seed) {
            ++calls;
            CHECK(seed == 77);
        }));
    }
    CHECK(calls == 1);
    const environment none("");
    CHECK(try_launch({}, [](const checked&) {}).seed == 1);
    std::vector<std::uint64_t> seeds;
    CHECK(emulator::for_each_seed(4, [&](std::uint64_t seed) { seeds.push_back(seed); }));
    CHECK(seeds == std::vector<std::uint64_t>{1, 2, 3, 4});
    const outcome o = in_another_process([] {
        const environment bad("12x");
        emulator::seed_in_environment();
    });
    CHECK(o.text == "warpagg: WARPAGG_SEED=12x is not a number\n");
    CHECK(WEXITSTATUS(o.status) == EXIT_FAILURE);
}

TEST_CASE("for_each_seed stops at the first failure and prints its seed") {
    const outcome o = in_another_process([] {
        unsigned calls = 0;
        const environment none("");
        const bool passed = emulator::for_each_seed(200, [&](std::uint64_t seed) {
            ++calls;
            return seed != 12;
        });
        _exit(!passed && calls == 12 ? 0 : 1);
    });
    CHECK(o.text == "warpagg: failed; replay with WARPAGG_SEED=12\n");
    CHECK(o.status == 0);
    const outcome thrown = in_another_process([] {
        try {
            const environment none("");
            emulator::for_each_seed(200, [](std::uint64_t seed) {
                if (seed == 9) throw std::runtime_error("nine");
            });
        } catch (const std::runtime_error&) {
            _exit(9);
        }
    });
    CHECK(thrown.text == "warpagg: failed; replay with WARPAGG_SEED=9\n");
    CHECK(WEXITSTATUS(thrown.status) == 9);
}

TEST_CASE("launch prints the report and aborts") {
    const outcome o = in_another_process([] { emulator::launch({.seed = 42}, breaks_a_rule); });
    CHECK(WIFSIGNALED(o.status));
    CHECK(WTERMSIG(o.status) == SIGABRT);
    CHECK(o.text == try_launch({.seed = 42}, breaks_a_rule).text());
    CHECK(o.text.find("\n  lane 3 (0x00000008) of warp 0 of block 0\n") != std::string::npos);
    CHECK(o.text.find("\n  replay with WARPAGG_SEED=42\n") != std::string::npos);

    const outcome odd = in_another_process([] { emulator::launch({.threads = 33}, breaks_a_rule); });
    CHECK(odd.text == "warpagg: 33 threads in a block; it takes a multiple of 32, up to 1024\n");
    CHECK(WTERMSIG(odd.status) == SIGABRT);
}

TEST_CASE("after a diagnosis lanes stay where they are, and the next launch is as any") {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        unsigned after = 0;
        std::vector<char> memory(1000);
        const auto r = try_launch({.blocks = 2, .threads = 64, .seed = seed}, [&](const checked& w) {
            const std::array<char, 1000> deep{};
            w.store(memory.data(), w.lane(), deep[w.lane()], false);
            breaks_a_rule(w);
            w.barrier();
            ++after;
        });
        CHECK(r.what == diagnosis::collective_not_reached);
        CHECK(after == 0);
        CHECK(last_commits(seed) == last_commits(seed));
    }
}

TEST_CASE("a lane has a stack of 256 KiB, and who needs more does not get on") {
    const auto go_down = [](unsigned levels) {
        return in_another_process([levels] {
            const auto r = try_launch({}, [levels](const checked&) {
                if (descend(levels) != levels) std::abort();
            });
            _exit(r.ok() ? 0 : 1);
        });
    };
    CHECK(go_down(128).status == 0);
    CHECK(go_down(300).status != 0);
}

TEST_CASE("an exception that leaves the kernel leaves the launch") {
    const auto throws = [](const checked& w) {
        w.any(true);
        if (w.lane() == 4) throw std::out_of_range("lane 4");
        w.any(true);
    };
    CHECK_THROWS_WITH_AS(try_launch({}, throws), "lane 4", std::out_of_range);
    const auto catches = [](const checked& w) {
        try {
            throw w.lane();
        } catch (unsigned lane) {
            CHECK(lane == w.lane());
        }
        w.any(true);
    };
    CHECK(try_launch({}, catches).ok());
}

TEST_CASE("threads know where they are") {
    std::vector<unsigned> seen(3 * 96);
    const auto r = try_launch({.blocks = 3, .threads = 96}, [&](const checked& w) {
        CHECK(w.block_size() == 96);
        CHECK(w.grid_size() == 3);
        CHECK(w.lane() == w.thread_index() % 32);
        ++seen[w.block_index() * w.block_size() + w.thread_index()];
    });
    CHECK(r.ok());
    CHECK(std::count(seen.begin(), seen.end(), 1u) == 3 * 96);
}

TEST_CASE("a block has its shared arrays to itself") {
    for_each_seed(20, [](std::uint64_t seed) {
        std::vector<unsigned> totals(4);
        const auto r = try_launch({.blocks = 4, .threads = 64, .seed = seed}, [&](const checked& w) {
            const auto values = w.shared<unsigned>(w.block_size());
            const auto total = w.shared<unsigned>(1);
            values[w.thread_index()] = w.thread_index() + w.block_index();
            if (w.thread_index() == 63) total[0] = 0;
            w.barrier();
            if (w.thread_index() == 0)
                for (unsigned t = 0; t < 64; ++t) total[0] += values[t];
            w.barrier();
            if (w.thread_index() == 40) totals[w.block_index()] = total[0];
        });
        CHECK(r.text() == "");
        CHECK(totals == std::vector<unsigned>{2016, 2080, 2144, 2208});
    });
}

TEST_CASE("masked operations are CUDA's") {
    const auto r = try_launch({}, [](const checked& w) {
        const unsigned lane = w.lane();
        if (lane < 8) return;
        const std::uint32_t mask = 0xffffff00u;
        CHECK(w.ballot_sync(mask, lane % 2 == 0) == 0x55555500u);
        CHECK(w.any_sync(mask, lane == 9));
        CHECK_FALSE(w.any_sync(mask, lane == 3));
        CHECK(w.match_any_sync(mask, lane < 16 ? 0.5f : 1.5f) == (lane < 16 ? 0xff00u : 0xffff0000u));
        CHECK(w.shfl_sync(mask, lane, 40 + lane % 2) == 8 + lane % 2);  // modulo 32
        CHECK(w.shfl_down_sync(mask, lane, 3) == (lane < 29 ? lane + 3 : lane));
        CHECK(w.shfl_down_sync(mask, lane, 0xffffffffu) == lane);
        CHECK(w.shfl_xor_sync(mask, lane, 7) == (lane ^ 7u));
    });
    CHECK(r.text() == "");
}

TEST_CASE("activemask is a consistent partition of the lanes that are there") {
    std::set<std::uint32_t> answers;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        std::array<std::uint32_t, 32> mask{};
        const auto r = try_launch({.seed = seed}, [&](const checked& w) {
            if (w.lane() % 3 == 0) return;
            for (unsigned i = 0; i <= w.lane() % 4; ++i) {
                mask[w.lane()] = w.activemask();
                w.sync(mask[w.lane()]);  // whoever is named comes too
            }
        });
        CHECK(r.text() == "");
        for (unsigned lane = 0; lane < 32; ++lane) {
            if (lane % 3 == 0) continue;
            CHECK((mask[lane] >> lane & 1u) == 1u);
            CHECK((mask[lane] & 0x49249249u) == 0u);  // the lanes that have returned
            answers.insert(mask[lane]);
        }
    }
    CHECK(answers.size() > 100);
    // Sooner or later all present lanes are named.
    CHECK(std::any_of(answers.begin(), answers.end(),
                      [](std::uint32_t m) { return __builtin_popcount(m) > 4; }));
}

TEST_CASE("it counts as counted_lanes does") {
    const auto compare = [](auto how, unsigned busy) {
        emulator::counters one, other;
        alignas(32) float sums[9] = {};
        warpagg::simd_value<float, 32> v[9];
        for (auto& x : v) x = warpagg::simd_value<float, 32>(1.0f);
        const emulator::counted_lanes w{{&one}};
        warpagg::warp_reduce_atomic(w, sums, v, w.lane() < busy, how);
        const float v1[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
        const auto r = try_launch({.count = &other}, [&](const checked& c) {
            warpagg::warp_reduce_atomic(c, sums, v1, c.lane() < busy, how);
        });
        CHECK(r.text() == "");
        CHECK(other.shuffles == one.shuffles);
        CHECK(other.votes == one.votes);
        CHECK(other.atomics == one.atomics);
        CHECK(other.commits == one.commits);
        CHECK(other.sectors == one.sectors);
        CHECK(other.active == one.active);
    };
    for (const unsigned busy : {1u, 5u, 32u}) {
        compare(policy<reduce::scatter>{}, busy);
        compare(policy<reduce::shfl_down>{}, busy);
        compare(policy<reduce::butterfly, commit::contiguous>{}, busy);
        compare(policy<reduce::per_lane>{}, busy);
        compare(policy<reduce::scatter, gate::at_least<4>>{}, busy);
    }
}

TEST_CASE("many warps under all reductions") {
    const auto add = [](auto how) {
        for_each_seed(20, [&](std::uint64_t seed) {
            std::vector<unsigned> sums(5);
            const auto r = try_launch({.blocks = 2, .threads = 96, .seed = seed}, [&](const checked& w) {
                const unsigned t = w.thread_index();
                const unsigned v[5] = {1, t, t * t, w.block_index(), 7};
                for (const unsigned i : warpagg::iterations(w, 3))
                    warpagg::warp_reduce_atomic(w, sums.data(), v, t % 3 != i, how);
            });
            CHECK(r.text() == "");
            CHECK(sums == std::vector<unsigned>{384, 18240, 1161280, 192, 2688});
        });
    };
    add(policy<>{});
    add(policy<reduce::scatter>{});
    add(policy<reduce::shfl_down>{});
    add(policy<reduce::butterfly, commit::contiguous>{});
    add(policy<reduce::per_lane>{});
    add(policy<reduce::scatter, gate::at_least<22>>{});
}

TEST_CASE("launches on several threads at once, and one within a kernel") {
    std::array<bool, 4> ok{};
    std::vector<std::thread> threads;
    const std::vector<unsigned> expected = order_of({.seed = 3});
    for (bool& mine : ok)
        threads.emplace_back([&] {
            for (int i = 0; i < 20; ++i) mine = order_of({.seed = 3}) == expected;
        });
    for (auto& t : threads) t.join();
    CHECK(std::count(ok.begin(), ok.end(), true) == 4);

    unsigned inner = 0;
    const auto r = try_launch({}, [&](const checked& w) {
        if (w.any(w.lane() == 3) && w.lane() == 3)
            CHECK(try_launch({}, [&](const checked&) { ++inner; }).ok());
        w.any(true);
    });
    CHECK(r.text() == "");
    CHECK(inner == 32);
}

TEST_SUITE_END();
