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
    unsigned threads = 32;                ///< threads per block: a multiple of the warp's, up to 1024
    std::optional<std::uint64_t> seed{};  ///< seed of the schedule; default: $WARPAGG_SEED, or 1
    counters* count = nullptr;            ///< counters for the operations of all warps, or null
};

/// Runs `kernel(const checked& w)` once per thread and returns the report. The seed determines the
/// order of blocks, which run one after the other, and the turns of a block's threads. A diagnosis
/// ends the launch: lanes do not continue, and destructors of objects on their stacks do not run.
/// `try_launch<wide_checked>` runs the kernel in warps of 64 lanes.
///
/// Errors: rethrows an exception that leaves the kernel. Aborts the program if `g.threads` is not
/// allowed.
///
/// Cost: about one switch of fibers per operation of each lane, which is fast enough for tests only.
/// A launch uses one thread of the process; several threads may launch at the same time.
template <class Warp = checked, class Kernel>
report try_launch(const grid& g, const Kernel& kernel) {
    if (g.threads == 0 || g.threads > 1024 || g.threads % Warp::size != 0) {
        std::fprintf(stderr, "warpagg: %u threads in a block; it takes a multiple of %u, up to 1024\n",
                     g.threads, Warp::size);
        std::abort();
    }
    const std::uint64_t seed = g.seed.value_or(seed_in_environment().value_or(1));
    detail::simulator s(g.blocks, g.threads, Warp::size, seed, g.count);
    return s.run([&kernel](detail::simulator& m) { kernel(Warp(m)); });
}

/// Works as `try_launch`, but prints a diagnosis on stderr and aborts the program.
template <class Warp = checked, class Kernel>
void launch(const grid& g, const Kernel& kernel) {
    const report r = try_launch<Warp>(g, kernel);
    if (r.ok()) return;
    std::fputs(r.text().c_str(), stderr);
    std::abort();
}

}  // namespace warpagg::emulator
