// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "model.hpp"
#include "seeds.hpp"

namespace warpagg::emulator {

/// What a kernel is launched with.
struct grid {
    unsigned blocks = 1;                  ///< how many
    unsigned threads = 32;                ///< in a block: a multiple of 32, up to 1024
    std::optional<std::uint64_t> seed{};  ///< of the schedule; else WARPAGG_SEED of the environment, else 1
    counters* count = nullptr;  ///< to what the warps add what they do, as `counted_lanes` does; or null
};

/// Runs `kernel(const checked& w)` once per thread: the blocks one after the other, in an order that the seed
/// draws; within a block all threads side by side, taking turns as the seed draws. Returns how it went; after
/// a diagnosis no lane goes on, and the destructors of what lives in their stacks do not run. An exception
/// that leaves the kernel leaves `try_launch` too.
///
/// Cost: a switch of fibers for each operation of each lane: slow, but it is for tests. One launch uses
/// one thread of the process; several threads may launch at the same time.
template <class Kernel>
report try_launch(const grid& g, const Kernel& kernel) {
    if (g.threads == 0 || g.threads > 1024 || g.threads % 32 != 0) {
        std::fprintf(stderr, "warpagg: %u threads in a block; it takes a multiple of 32, up to 1024\n",
                     g.threads);
        std::abort();
    }
    const std::uint64_t seed = g.seed.value_or(seed_in_environment().value_or(1));
    return detail::simulator(g.blocks, g.threads, seed, g.count).run([&kernel](detail::simulator& m) {
        kernel(checked(m));
    });
}

/// The same, but a diagnosis is printed on stderr and ends the program.
template <class Kernel>
void launch(const grid& g, const Kernel& kernel) {
    const report r = try_launch(g, kernel);
    if (r.ok()) return;
    std::fputs(r.text().c_str(), stderr);
    std::abort();
}

}  // namespace warpagg::emulator
