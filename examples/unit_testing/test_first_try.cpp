// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>
#include <warpagg/warp/checked.hpp>

#include "first_try.hpp"

namespace emulator = warpagg::emulator;

int main() {
    const std::vector<float> samples(100, 1.0f);
    float moments[3] = {};
    const emulator::report r =
        emulator::try_launch({.blocks = 2, .threads = 64}, [&](const emulator::checked& w) {
            const unsigned i = w.block_index() * w.block_size() + w.thread_index();
            add_moments(w, i, samples.data(), 100, moments);
        });
    std::printf("%s", r.text().c_str());
    return r.what == emulator::diagnosis::collective_not_reached ? 0 : 1;
}
