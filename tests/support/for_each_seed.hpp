// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <warpagg/warp/checked/seeds.hpp>

/// The library's, with doctest told of the seed, whose CHECK neither throws nor returns.
template <class F>
void for_each_seed(std::uint64_t n, F f) {
    warpagg::emulator::for_each_seed(n, [&f](std::uint64_t seed) {
        INFO("WARPAGG_SEED=", seed);
        f(seed);
    });
}
