// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

/// Which lanes take part: the first `count` always, the others where a random number is below `chance`.
struct activity {
    unsigned count;
    std::uint32_t chance;
};

/// What bench_atomics runs: one kernel for each policy, type and number of values. A file of variants is
/// compiled for each number of values and registers its own here. `aligned`: whether records start at a
/// multiple of 16 bytes.
struct variant {
    const char* type;
    int n;
    const char* policy;
    bool aligned;
    void (*launch)(void* memory, activity);
};

inline std::vector<variant>& variants() {
    static std::vector<variant> all;
    return all;
}

constexpr unsigned records = 1u << 20, blocks = 132 * 16, threads = 128, steps_per_warp = 2048;
constexpr unsigned seed = 12345;
