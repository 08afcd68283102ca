// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdio>
#include <vector>
#include <warpagg/warp/checked.hpp>

#include "moments.hpp"

namespace emulator = warpagg::emulator;

/// n samples of value 2, so that sums are exact in any order.
bool sums_are_right(unsigned n, std::uint64_t seed) {
    const std::vector<float> samples(n, 2.0f);
    float moments[3] = {};
    emulator::counters did;
    emulator::launch({.blocks = 2, .threads = 64, .seed = seed, .count = &did},
                     [&](const emulator::checked& w) {
                         const unsigned i = w.block_index() * w.block_size() + w.thread_index();
                         add_moments(w, i, samples.data(), n, moments);
                     });
    const auto count = static_cast<float>(n);
    const bool idle_warps_write_nothing = did.commits <= 3 * ((n + 31) / 32);
    return moments[0] == count && moments[1] == 2 * count && moments[2] == 4 * count &&
           idle_warps_write_nothing;
}

int main() {
    for (const unsigned n : {0u, 1u, 31u, 32u, 64u, 100u, 128u})
        if (!emulator::for_each_seed(200, [n](std::uint64_t seed) { return sums_are_right(n, seed); }))
            return 1;
    std::puts("moments: passed");
}
