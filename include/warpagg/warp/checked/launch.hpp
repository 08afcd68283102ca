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

/// The parameters of a launch.
struct grid {
    unsigned blocks = 1;                  ///< number of blocks
    unsigned threads = 32;                ///< per block: a multiple of 32, up to 1024
    std::optional<std::uint64_t> seed{};  ///< of the schedule; default: $WARPAGG_SEED, or 1
    counters* count = nullptr;            ///< counts the operations of all warps; or null
};

/// Runs `kernel(const checked& w)` once per thread. Blocks run one after the other, in an order
/// drawn from the seed; the threads of a block take turns, as drawn from the seed. After a
/// diagnosis the launch ends: lanes do not continue, and destructors of objects on their stacks do
/// not run. An exception that leaves the kernel leaves `try_launch`, too.
///
/// Cost: one switch of fibers per operation of each lane, which is slow, but fit for tests. A
/// launch uses one thread of the process; several threads may launch at the same time.
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

/// The same, but prints a diagnosis on stderr and aborts the program.
template <class Kernel>
void launch(const grid& g, const Kernel& kernel) {
    const report r = try_launch(g, kernel);
    if (r.ok()) return;
    std::fputs(r.text().c_str(), stderr);
    std::abort();
}

}  // namespace warpagg::emulator
